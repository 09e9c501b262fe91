#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

/// What the fuzzer does with bytes of any origin, one function for every parser
/// (docs/contributing.md). Each returns, whatever the bytes are; what must never be ends the
/// process.
namespace irdm::fuzz {

using Input = std::span<const std::uint8_t>;

/// Ends the process, and says why, when something that always holds does not.
void expect(bool holds, const char* what);

/// The bytes as text.
std::string_view text_of(Input input);

/// One byte: which message between server and viewer (those of a viewer, scene, health, state,
/// frame); the message. What can be decoded, can be encoded and decoded again.
void viewer_message(Input input);

/// Lines: Origin, Host, token given, token wanted, list of codings or entity tags.
void request_rules(Input input);
/// All that a peer sends to the viewer's server on one connection; after an empty line, to one that
/// wants a token.
void http_connection(Input input);

/// One byte: 0 puts the right checksums into the frames first, and how many bytes come at a time;
/// then the stream.
void wire_frames(Input input);
/// Datagrams, one after the other: a byte, its remainder by 8: 0 anybody's bytes, 1 a text that the
/// bridge seals, 2 a frame that it sends, with a mended checksum, 3 the last once more, 4 the last
/// with another bit, else some get lost; length, bit or count as u16; of the first three the bytes.
void datagrams(Input input);
/// All that a bridge sends in a session, with mended checksums.
void bridge_session(Input input);
/// One byte: odd, the bridge can do lockstep; above 1, it stops, else it waits too long; then all
/// that a server sends in a session.
void server_session(Input input);
/// A session with datagrams; the first byte chooses: 1 the server plays in lockstep, 2 it has no
/// datagrams, 4 another bridge has a stylus, 8 which makes room, 16 the bridge does not greet by
/// itself, 32 cannot play in lockstep, 128 is cut off before it has greeted. Then records, as those
/// of datagrams(): by the remainder by 9: 0 bytes of the connection, with mended checksums, 1 a
/// text that the bridge seals, 2 a frame that it sends by datagrams, 3 anybody's datagram, 4 the
/// last once more, 5 the last with another bit, 6 some get lost, 7 forces come, 8 time passes [ms].
void bridge_datagrams(Input input);
/// The same of a bridge: 1 it can play in lockstep, 2 it does not predict, 4 wants no datagrams, 8
/// the server does not greet by itself, 16 has no datagrams, 32 plays in lockstep, 64 offers no
/// port, 128 the bridge stops at last. 7: samples and applied forces come.
void server_datagrams(Input input);
/// The payload of a contact model, and what a bridge makes of it.
void contact_model(Input input);

/// One byte: what Haply's service says, by the remainder by 3: 0 a message, and what the bridge
/// makes of it, 1 an event, 2 an answer of its version; then the text.
void service_message(Input input);

void scene_config(Input input);
void precompute_config(Input input);
void bridge_config(Input input);
void stylus_script(Input input);
void key_file(Input input);

void mesh_msh(Input input);
/// Nodes, a percent sign, elements.
void mesh_tetgen(Input input);
void mesh_vtk(Input input);
void mesh_vtu(Input input);
void mesh_medit(Input input);
void mesh_stl(Input input);
void mesh_obj(Input input);
void mesh_ply(Input input);
/// Edits of a valid file.
void model_file(Input input);
/// The same of one in half and single precision, with a compressed response.
void packed_model_file(Input input);
void trace_file(Input input);
void run_file(Input input);
/// Bytes of the header as u16, of a column as u8; header and columns, which get their checksums. A
/// column of 0 bytes: all of the file as it is.
void column_file(Input input);

/// Calls of the C interface, one after the other: a byte, its remainder by 8: 0 a step, 1 one with
/// a wrong number of commands, 2 contacts and objects, 3 a surface, 4 a state with another bit, 5 a
/// text as a state, 6 as a scene, 7 a reset; then what it is called with.
void c_calls(Input input);

struct Harness {
  std::string_view name;
  void (*run)(Input input);
};
inline constexpr std::array kHarnesses = {
    Harness{"viewer_message", viewer_message},
    Harness{"request_rules", request_rules},
    Harness{"http_connection", http_connection},
    Harness{"wire_frames", wire_frames},
    Harness{"datagrams", datagrams},
    Harness{"bridge_datagrams", bridge_datagrams},
    Harness{"server_datagrams", server_datagrams},
    Harness{"contact_model", contact_model},
    Harness{"bridge_session", bridge_session},
    Harness{"server_session", server_session},
    Harness{"service_message", service_message},
    Harness{"scene_config", scene_config},
    Harness{"precompute_config", precompute_config},
    Harness{"bridge_config", bridge_config},
    Harness{"stylus_script", stylus_script},
    Harness{"key_file", key_file},
    Harness{"mesh_msh", mesh_msh},
    Harness{"mesh_tetgen", mesh_tetgen},
    Harness{"mesh_vtk", mesh_vtk},
    Harness{"mesh_vtu", mesh_vtu},
    Harness{"mesh_medit", mesh_medit},
    Harness{"mesh_stl", mesh_stl},
    Harness{"mesh_obj", mesh_obj},
    Harness{"mesh_ply", mesh_ply},
    Harness{"model_file", model_file},
    Harness{"packed_model_file", packed_model_file},
    Harness{"trace_file", trace_file},
    Harness{"run_file", run_file},
    Harness{"column_file", column_file},
    Harness{"c_calls", c_calls},
};

}  // namespace irdm::fuzz
