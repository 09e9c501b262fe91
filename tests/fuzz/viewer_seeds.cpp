#include "tests/fuzz/seed_folder.hpp"
#include "tests/viewer/frames.hpp"
#include "viewer/message.hpp"

namespace irdm::fuzz {
namespace {

/// A message between server and viewer; `kind` as viewer_message() counts them.
void write_viewer(const Seeds& seeds, std::uint8_t kind, const std::string& name, SeedBytes bytes) {
  bytes.insert(bytes.begin(), kind);
  seeds.write("viewer_message", name, bytes);
}

void write_client_messages(const Seeds& seeds) {
  const auto hello = encode(viewer::ClientMessage(viewer::Hello{"0123456789abcdef"}));
  const auto reset = encode(viewer::ClientMessage(viewer::Command{}));
  write_viewer(seeds, 0, "hello", hello);
  write_viewer(seeds, 0, "no_token", encode(viewer::ClientMessage(viewer::Hello{})));
  write_viewer(seeds, 0, "reset", reset);
  write_viewer(seeds, 0, "seek",
               encode(viewer::ClientMessage(viewer::Command{viewer::CommandKind::kSeek, 0, 1.5})));
  write_viewer(
      seeds, 0, "too_fast",
      encode(viewer::ClientMessage(viewer::Command{viewer::CommandKind::kSetSpeed, 0, 99.0})));
  write_viewer(
      seeds, 0, "save_scene",
      encode(viewer::ClientMessage(viewer::Command{viewer::CommandKind::kSaveScene, 0, 0.0})));
  write_viewer(seeds, 0, "load_scene",
               encode(viewer::ClientMessage(viewer::SceneRequest{"press.toml"})));
  write_viewer(seeds, 0, "onlooker", encode(viewer::ClientMessage(viewer::Hello{"a", true})));
  write_viewer(seeds, 0, "stylus",
               encode(viewer::ClientMessage(viewer::StylusRequest{true, 1, Vector3(1, 2, 3)})));
  write_viewer(
      seeds, 0, "settings",
      encode(viewer::ClientMessage(viewer::SettingsRequest{test::example_state().settings, 2})));
}

/// A browser's whole connection, with a mask that changes nothing.
std::string browser(const std::vector<viewer::ClientMessage>& messages) {
  std::string bytes =
      "GET /live HTTP/1.1\r\nHost: 127.0.0.1:1\r\nOrigin: http://127.0.0.1:1\r\n"
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  for (const viewer::ClientMessage& message : messages) {
    const SeedBytes content = encode(message);
    bytes += {'\x82', static_cast<char>(0x80 | content.size()), 0, 0, 0, 0};
    bytes.append(content.begin(), content.end());
  }
  return bytes;
}

void write_connections(const Seeds& seeds) {
  const viewer::ClientMessage stylus = viewer::StylusRequest{true, 1, Vector3(1, 2, 3)};
  const viewer::ClientMessage command = viewer::Command{};
  const viewer::ClientMessage settings = viewer::SettingsRequest{test::example_state().settings, 1};
  const auto viewer = [&](const std::string& token) {
    return browser({viewer::Hello{token}, command, stylus, settings, command});
  };
  seeds.write("http_connection", "viewer", viewer(""));
  seeds.write("http_connection", "stylus_first", browser({stylus}));
  seeds.write("http_connection", "full", "\n" + viewer("0123456789abcdef"));
  seeds.write("http_connection", "onlooker", "\n" + viewer("fedcba9876543210"));
  seeds.write("http_connection", "wrong_token", "\n" + viewer("0123456789abcdee"));
  seeds.write("http_connection", "no_page", std::string("\nGET / HTTP/1.1\r\nHost: a\r\n\r\n"));
  seeds.write("http_connection", "long_header",
              "GET / HTTP/1.1\r\nHost: a\r\nX: " + std::string(9000, 'a') + "\r\n\r\n");
}

void write_server_messages(const Seeds& seeds) {
  const viewer::Scene scene = test::example_scene();
  write_viewer(seeds, 1, "scene", encode(scene));
  write_viewer(seeds, 2, "health", encode(viewer::Health{.links = {{}, {true}}}));
  write_viewer(seeds, 3, "state", encode(test::example_state()));
  for (const double size : {0.01, 2.0}) {
    SeedBytes message;
    viewer::encode(test::example_frame(scene, size), message);
    SeedBytes bytes = {static_cast<std::uint8_t>(scene.objects.size())};
    for (const std::size_t count : test::node_counts(scene)) {
      bytes.push_back(static_cast<std::uint8_t>(count));
    }
    bytes.insert(bytes.end(), message.begin(), message.end());
    write_viewer(seeds, 4, size < 1.0 ? "small" : "large", bytes);
  }
}

}  // namespace

void write_viewer_seeds(const Seeds& seeds) {
  write_client_messages(seeds);
  write_connections(seeds);
  write_server_messages(seeds);
}

}  // namespace irdm::fuzz
