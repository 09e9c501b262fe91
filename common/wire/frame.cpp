#include "common/wire/frame.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "common/wire/bytes.hpp"
#include "common/wire/crc32c.hpp"
#include "common/wire/protocol_error.hpp"

namespace irdm::wire {
namespace {

constexpr std::size_t kChecksumSize = 4;
constexpr std::size_t kChecked = kHeaderSize - kChecksumSize;  // of the header, by the checksum

}  // namespace

FrameBytes encode_frame(const Message& message, std::uint32_t session, std::uint64_t sequence,
                        std::int64_t send_time_ns) {
  const MessageType type = type_of(message);
  const std::size_t size = payload_size(type).value();
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
  if (header_.payload_size != *expected) {
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
