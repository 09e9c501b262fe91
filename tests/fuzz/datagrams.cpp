#include <algorithm>
#include <optional>
#include <vector>

#include "common/wire/frame_parts.hpp"
#include "common/wire/key_material.hpp"
#include "common/wire/protocol_error.hpp"
#include "common/wire/stream_order.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/mended_frames.hpp"

namespace irdm::fuzz {

using namespace irdm::wire;

namespace {

using Bytes = std::vector<std::uint8_t>;

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
    const std::span<const std::uint8_t> datagram =
        bridge_.seal(text.first(std::min(text.size(), kLargestText)));
    last_.assign(datagram.begin(), datagram.end());
    take(server_.open(last_));
    again();
  }
  /// The last datagram comes twice.
  void again() {
    if (last_.empty()) return;
    expect(server_.open(last_).verdict == DatagramVerdict::kReplayed, "a datagram opens once");
  }
  /// The last one, but for a bit.
  void spoilt(std::size_t bit) {
    if (last_.empty()) return;
    Bytes datagram = last_;
    datagram[bit / 8 % datagram.size()] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    foreign(datagram);
  }
  /// So many get lost.
  void lost(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) bridge_.seal({});
  }
  /// All parts of a frame, from the last to the first.
  void frame(Input bytes) {
    Bytes frame(bytes.begin(), bytes.end());
    frame.resize(std::min(frame.size(), kHeaderSize + kLargestPayload));
    mend(frame);
    std::vector<Bytes> datagrams;
    for (std::size_t part = 0; part < part_count(frame); ++part) {
      const auto datagram = bridge_.seal(part_text(frame, part).view());
      datagrams.emplace_back(datagram.begin(), datagram.end());
    }
    std::for_each(datagrams.rbegin(), datagrams.rend(),
                  [this](const Bytes& each) { take(server_.open(each)); });
  }

 private:
  void take(const DatagramChannel::Opened& opened) {
    expect(opened.verdict == DatagramVerdict::kOpened, "what the bridge seals opens");
    if (is_probe(opened.text)) return;
    const std::optional<Frame> frame = assembly_.take(opened.number, opened.text);
    if (!frame) return;
    Bytes bytes(assembly_.bytes().begin(), assembly_.bytes().end());
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
  DatagramChannel bridge_{keys_, DatagramEnd::kBridge, kFuzzedSession};
  DatagramChannel server_{keys_, DatagramEnd::kServer, kFuzzedSession};
  FrameAssembly assembly_;
  StreamOrder order_;
  Bytes last_;
};

}  // namespace

void datagrams(Input input) {
  constexpr std::size_t kRecord = 3;
  Path path;
  try {
    while (input.size() >= kRecord) {
      const std::size_t number = input[1] + 256u * input[2];
      const std::uint8_t kind = input[0];
      input = input.subspan(kRecord);
      const Input bytes = input.first(std::min(number, input.size()));
      if (kind % 8 < 3) input = input.subspan(bytes.size());
      switch (kind % 8) {
        case 0:
          path.foreign(bytes);
          break;
        case 1:
          path.sealed(bytes);
          break;
        case 2:
          path.frame(bytes);
          break;
        case 3:
          path.again();
          break;
        case 4:
          path.spoilt(number);
          break;
        default:
          path.lost(number % 2048);
      }
    }
  } catch (const ProtocolError&) {
  }
}

}  // namespace irdm::fuzz
