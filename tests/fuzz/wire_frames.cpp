#include <algorithm>
#include <vector>

#include "common/wire/bytes.hpp"
#include "common/wire/frame.hpp"
#include "common/wire/protocol_error.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/mended_frames.hpp"

namespace irdm::fuzz {

using namespace irdm::wire;

namespace {

constexpr std::size_t kSizeOffset = 8;
constexpr std::size_t kChecksumOffset = kHeaderSize - 4;

}  // namespace

void mend(std::span<std::uint8_t> stream) {
  while (stream.size() >= kHeaderSize) {
    const auto size = ByteReader(stream.subspan(kSizeOffset, 4)).get<std::uint32_t>();
    if (size > stream.size() - kHeaderSize) return;
    const std::uint32_t sum =
        crc32c(stream.first(kChecksumOffset), stream.subspan(kHeaderSize, size));
    ByteWriter(stream.subspan(kChecksumOffset, 4)).put(sum);
    stream = stream.subspan(kHeaderSize + size);
  }
}

namespace {

void check_again(const Frame& frame) {
  const auto encode = [](const Frame& it) {
    return encode_frame(it.message, it.header.session, it.header.sequence, it.header.send_time_ns);
  };
  const FrameBytes bytes = encode(frame);
  FrameReader reader;
  std::span<const std::uint8_t> rest = bytes.view();
  const std::optional<Frame> again = reader.read(rest);
  expect(again && rest.empty(), "a frame that was encoded here can be read");
  expect(std::ranges::equal(encode(*again).view(), bytes.view()),
         "a frame that was encoded here stays the same");
}

}  // namespace

void wire_frames(Input input) {
  if (input.empty()) return;
  const std::size_t piece = input[0] == 0 ? input.size() : input[0];
  std::vector<std::uint8_t> stream(input.begin() + 1, input.end());
  if (input[0] == 0) mend(stream);
  FrameReader reader;
  try {
    for (std::span<const std::uint8_t> left(stream); !left.empty();) {
      std::span<const std::uint8_t> next = left.first(std::min(piece, left.size()));
      left = left.subspan(next.size());
      while (const std::optional<Frame> frame = reader.read(next)) check_again(*frame);
      expect(next.empty(), "the reader takes all that it is given");
    }
  } catch (const ProtocolError&) {
  }
}

}  // namespace irdm::fuzz
