#include <algorithm>
#include <optional>
#include <vector>

#include "common/wire/frame.hpp"
#include "common/wire/protocol_error.hpp"
#include "common/wire/secret_key.hpp"
#include "common/wire/stream.hpp"
#include "tests/fuzz/far_end.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/mended_frames.hpp"

namespace irdm::fuzz {

using namespace irdm::wire;

namespace {

/// A bridge that knows the key and says what the fuzzer likes, and the server's end.
class Path {
 public:
  /// Bytes of anybody.
  void foreign(Input datagram) {
    const DatagramVerdict verdict = server_.open(datagram).verdict;
    expect(verdict != DatagramVerdict::kOpened, "nothing opens that was not sealed with the key");
  }
  /// A text of the bridge's.
  void sealed(Input text) {
    take(server_.open(bridge_.sealed(text)));
    again();
  }
  /// The last datagram comes twice.
  void again() {
    if (bridge_.last().empty()) return;
    expect(server_.open(bridge_.last()).verdict == DatagramVerdict::kReplayed,
           "a datagram opens once");
  }
  /// The last one, but for a bit.
  void spoilt(std::size_t bit) {
    if (!bridge_.last().empty()) foreign(bridge_.spoilt(bit));
  }
  /// So many get lost.
  void lost(std::size_t count) { bridge_.lose(count); }
  /// All parts of a frame, from the last to the first.
  void frame(Input bytes) {
    const auto datagrams = bridge_.frame(bytes);
    std::for_each(datagrams.rbegin(), datagrams.rend(),
                  [this](Input each) { take(server_.open(each)); });
  }

 private:
  void take(const DatagramChannel::Opened& opened) {
    expect(opened.verdict == DatagramVerdict::kOpened, "what the bridge seals opens");
    if (is_probe(opened.text)) return;
    const std::optional<Frame> frame = assembly_.take(opened.number, opened.text);
    if (!frame) return;
    const std::vector<std::uint8_t> bytes(assembly_.bytes().begin(), assembly_.bytes().end());
    FrameReader reader;
    std::span<const std::uint8_t> rest(bytes);
    expect(reader.read(rest) && rest.empty(), "what was put together is one frame");
    order_.take(*frame);
    expect(!is_of_stream(frame->message) || !known(frame->message) || !order_.take(*frame),
           "a message of the stream is news once");
  }
  static bool known(const Message& message) {
    return std::visit(
        [](const auto& each) {
          if constexpr (requires { each.stylus; }) return each.stylus < 64;
          return true;
        },
        message);
  }

  DatagramKeys keys_ = keys_of({1, 2, 3});
  FarEnd bridge_{keys_, DatagramEnd::kBridge, kFuzzedSession};
  DatagramChannel server_{keys_, DatagramEnd::kServer, kFuzzedSession};
  FrameAssembly assembly_;
  StreamOrder order_;
};

}  // namespace

void datagrams(Input input) {
  enum { kForeign, kSealed, kFrame, kAgain, kSpoilt };
  constexpr std::uint8_t kKinds = 8;
  Path path;
  Records records(input, kKinds, kAgain);
  try {
    while (const auto record = records.next()) {
      switch (record->kind) {
        case kForeign:
          path.foreign(record->bytes);
          break;
        case kSealed:
          path.sealed(record->bytes);
          break;
        case kFrame:
          path.frame(record->bytes);
          break;
        case kAgain:
          path.again();
          break;
        case kSpoilt:
          path.spoilt(record->number);
          break;
        default:
          path.lost(record->number % 2048);
      }
    }
  } catch (const ProtocolError&) {
  }
}

}  // namespace irdm::fuzz
