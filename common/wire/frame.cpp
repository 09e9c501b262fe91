#include "common/wire/frame.hpp"

#include <algorithm>
#include <boost/crc.hpp>
#include <string>
#include <utility>

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
  return text.size() == kLargestText && without_zeros(text).empty();
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

std::uint32_t crc32c(std::span<const std::uint8_t> first,
                     std::span<const std::uint8_t> second) noexcept {
  boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> crc;
  crc.process_bytes(first.data(), first.size());
  crc.process_bytes(second.data(), second.size());
  return crc.checksum();
}

namespace {

constexpr std::size_t kChecksumSize = 4;
constexpr std::size_t kChecked = kHeaderSize - kChecksumSize;  // of the header, by the checksum

}  // namespace

FrameBytes encode_frame(const Message& message, std::uint32_t session, std::uint64_t sequence,
                        std::int64_t send_time_ns) {
  const MessageType type = type_of(message);
  const std::size_t size = payload_size(message);
  FrameBytes frame;
  frame.size = kHeaderSize + size;
  const std::span<std::uint8_t> header(frame.storage.data(), kHeaderSize);
  const std::span<std::uint8_t> payload(frame.storage.data() + kHeaderSize, size);
  encode_payload(message, payload);
  ByteWriter out(header);
  out.put(kProtocolMagic);
  out.put(kProtocolVersion);
  out.put(static_cast<std::uint16_t>(type));
  out.put(static_cast<std::uint32_t>(size));
  out.put(session);
  out.put(sequence);
  out.put(send_time_ns);
  out.put(crc32c(header.first(kChecked), payload));
  return frame;
}

bool FrameReader::fill(std::span<const std::uint8_t>& bytes, std::size_t wanted) noexcept {
  if (filled_ < wanted) {
    const std::size_t count = std::min(wanted - filled_, bytes.size());
    std::copy_n(bytes.begin(), count, frame_.begin() + static_cast<std::ptrdiff_t>(filled_));
    filled_ += count;
    bytes = bytes.subspan(count);
  }
  return filled_ >= wanted;
}

void FrameReader::check_header() {
  ByteReader in(std::span<const std::uint8_t>(frame_).first(kHeaderSize));
  if (in.get<std::uint32_t>() != kProtocolMagic) {
    throw ProtocolError(ProtocolFault::kWrongMagic, "the peer does not speak this protocol");
  }
  header_.version = in.get<std::uint16_t>();
  if (header_.version < kOldestProtocolVersion || header_.version > kProtocolVersion) {
    throw VersionMismatch(header_.version, header_.version, kOldestProtocolVersion,
                          kProtocolVersion);
  }
  header_.type = static_cast<MessageType>(in.get<std::uint16_t>());
  header_.payload_size = in.get<std::uint32_t>();
  header_.session = in.get<std::uint32_t>();
  header_.sequence = in.get<std::uint64_t>();
  header_.send_time_ns = in.get_signed();
  checksum_ = in.get<std::uint32_t>();
  const std::string type = std::to_string(static_cast<int>(header_.type));
  const std::string length = std::to_string(header_.payload_size);
  if (header_.payload_size > kMaxPayload) {
    throw ProtocolError(ProtocolFault::kTooLong, "a payload of " + length + " bytes is too long");
  }
  const std::optional<std::size_t> expected = payload_size(header_.type);
  if (!expected) {
    throw ProtocolError(ProtocolFault::kUnknownType, "message type " + type + " is unknown");
  }
  const bool with_torque =
      header_.type == MessageType::kForce && header_.payload_size == kForceWithTorqueSize;
  if (header_.payload_size != *expected && !with_torque) {
    throw ProtocolError(ProtocolFault::kWrongLength,
                        "a message of type " + type + " with a payload of " + length + " bytes");
  }
}

std::optional<Frame> FrameReader::read(std::span<const std::uint8_t>& bytes) {
  if (filled_ < kHeaderSize) {
    if (!fill(bytes, kHeaderSize)) return std::nullopt;
    check_header();
  }
  if (!fill(bytes, kHeaderSize + header_.payload_size)) return std::nullopt;
  const std::span<const std::uint8_t> frame(frame_);
  const std::span<const std::uint8_t> payload = frame.subspan(kHeaderSize, header_.payload_size);
  if (crc32c(frame.first(kChecked), payload) != checksum_) {
    throw ProtocolError(ProtocolFault::kChecksum, "the checksum of a message is wrong");
  }
  const Frame whole{header_, decode_payload(header_.type, payload)};
  last_size_ = std::exchange(filled_, 0);
  return whole;
}

}  // namespace irdm::wire
