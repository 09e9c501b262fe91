#include <array>
#include <cmath>
#include <vector>

#include "tests/fuzz/harness.hpp"
#include "viewer/message.hpp"

namespace irdm::fuzz {

using namespace irdm::viewer;

namespace {

/// Reserved bytes are not looked at and written as zero: only from the second time on must the
/// bytes stay the same.
template <typename Decode, typename Encode>
void check_message_again(const viewer::Bytes& bytes, const Decode& decode, const Encode& encode) {
  try {
    expect(encode(decode(bytes)) == bytes, "a message that was encoded here stays the same");
  } catch (const MessageError&) {
    expect(false, "a message that was encoded here can be decoded");
  }
}

void client(Input input) {
  try {
    const ClientMessage message = decode_client(input);
    check_message_again(encode(message), decode_client, [](const auto& it) { return encode(it); });
  } catch (const MessageError&) {
  }
}

void scene(Input input) {
  try {
    const Scene scene = decode_scene(input);
    check_message_again(encode(scene), decode_scene, [](const auto& it) { return encode(it); });
  } catch (const MessageError&) {
  }
}

void health(Input input) {
  try {
    const Health health = decode_health(input);
    check_message_again(encode(health), decode_health, [](const auto& it) { return encode(it); });
  } catch (const MessageError&) {
  }
}

void state(Input input) {
  const auto decode = [](Input bytes) { return decode_state(bytes, 2); };
  try {
    const State state = decode(input);
    check_message_again(encode(state), decode, [](const auto& it) { return encode(it); });
  } catch (const MessageError&) {
  }
}

/// Whether all of it is within what 4-byte numbers hold.
bool in_reach(const Points& displacement) {
  constexpr double kFarthest = 20'000.0;
  return displacement.allFinite() && displacement.cwiseAbs().maxCoeff() < kFarthest;
}

/// One byte: number of objects; as many bytes: their nodes; the message.
void frame(Input input) {
  if (input.empty() || input[0] > 4 || input.size() <= input[0]) return;
  const std::vector<std::size_t> nodes(input.begin() + 1, input.begin() + 1 + input[0]);
  try {
    const SurfaceFrame frame = decode_frame(input.subspan(1u + input[0]), nodes);
    viewer::Bytes bytes;
    encode(frame, bytes);
    const SurfaceFrame again = decode_frame(bytes, nodes);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Points& before = frame.objects[i].displacement;
      if (nodes[i] == 0 || !in_reach(before)) continue;
      const double error = (again.objects[i].displacement - before).cwiseAbs().maxCoeff();
      expect(error <= 0.501 * kCoarsestUnit, "quantisation is within its bound");
    }
  } catch (const MessageError&) {
  }
}

}  // namespace

void viewer_message(Input input) {
  constexpr std::array<void (*)(Input), 5> kKinds = {client, scene, health, state, frame};
  if (!input.empty()) kKinds[input[0] % kKinds.size()](input.subspan(1));
}

}  // namespace irdm::fuzz
