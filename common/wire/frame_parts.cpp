#include "common/wire/frame_parts.hpp"

#include <algorithm>

#include "common/wire/bytes.hpp"
#include "common/wire/protocol_error.hpp"

namespace irdm::wire {
namespace {

[[noreturn]] void bad_part(const char* what) {
  throw ProtocolError(ProtocolFault::kBadValue, what);
}

std::span<const std::uint8_t> without_zeros(std::span<const std::uint8_t> frame) noexcept {
  while (!frame.empty() && frame.back() == 0) frame = frame.first(frame.size() - 1);
  return frame;
}

}  // namespace

std::size_t part_count(std::span<const std::uint8_t> frame) noexcept {
  return (without_zeros(frame).size() + kLargestPart - 1) / kLargestPart;
}

PartText part_text(std::span<const std::uint8_t> frame, std::size_t part) noexcept {
  const std::span<const std::uint8_t> sent = without_zeros(frame);
  const std::size_t begin = part * kLargestPart;
  const std::span<const std::uint8_t> bytes =
      sent.subspan(begin, std::min(kLargestPart, sent.size() - begin));
  PartText text;
  text.size = kPartHeaderSize + bytes.size();
  ByteWriter out(text.storage);
  out.put(static_cast<std::uint8_t>(part));
  out.put(static_cast<std::uint8_t>(part_count(frame)));
  out.put_zeros(2);
  std::copy(bytes.begin(), bytes.end(), text.storage.begin() + kPartHeaderSize);
  return text;
}

PartText probe_text() noexcept {
  PartText text{.storage = {}, .size = kLargestText};
  return text;
}

bool is_probe(std::span<const std::uint8_t> text) noexcept {
  return text.size() >= kPartHeaderSize && text[1] == 0;
}

FrameAssembly::Incomplete* FrameAssembly::find(std::uint64_t first, std::size_t parts) {
  Incomplete* place = incomplete_.data();
  for (Incomplete& each : incomplete_) {
    if (each.used && each.first == first) {
      if (each.parts != parts) bad_part("parts of a message that do not fit together");
      return &each;
    }
    if (place->used && (!each.used || each.first < place->first)) place = &each;
  }
  if (place->used && first < place->first) return nullptr;  // older than all
  place->used = true;
  place->first = first;
  place->parts = place->missing = parts;
  place->size = 0;
  return place;
}

std::optional<Frame> FrameAssembly::take(std::uint64_t number, std::span<const std::uint8_t> text) {
  if (text.size() <= kPartHeaderSize) bad_part("a datagram without a part of a message");
  const std::size_t part = text[0];
  const std::size_t parts = text[1];
  const std::span<const std::uint8_t> bytes = text.subspan(kPartHeaderSize);
  const bool last = part + 1 == parts;
  if (parts > kMostParts || part >= parts || number < part) bad_part("a part that cannot be");
  if (!last && bytes.size() != kLargestPart) bad_part("a part that is too short");
  if (parts == 1) return read(bytes);
  Incomplete* const frame = find(number - part, parts);
  if (frame == nullptr) return std::nullopt;
  const std::size_t begin = part * kLargestPart;
  std::copy(bytes.begin(), bytes.end(), frame->bytes.begin() + static_cast<std::ptrdiff_t>(begin));
  if (last) frame->size = begin + bytes.size();
  if (--frame->missing > 0) return std::nullopt;
  frame->used = false;
  return read(std::span(frame->bytes).first(frame->size));
}

Frame FrameAssembly::read(std::span<const std::uint8_t> bytes) {
  static constexpr std::array<std::uint8_t, kHeaderSize + kLargestPayload> kZeros{};
  reader_ = FrameReader();
  std::optional<Frame> frame = reader_.read(bytes);
  std::span<const std::uint8_t> zeros(kZeros);
  if (!frame) frame = reader_.read(zeros);
  if (!frame || !bytes.empty()) {
    throw ProtocolError(ProtocolFault::kWrongLength, "a datagram with more than a message");
  }
  return *frame;
}

}  // namespace irdm::wire
