#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/wire/message.hpp"
#include "common/wire/payload.hpp"

namespace irdm::wire {

/// One encoded frame: header and payload.
struct FrameBytes {
  std::array<std::uint8_t, kHeaderSize + kLargestPayload> storage;
  std::size_t size = 0;
  std::span<const std::uint8_t> view() const noexcept { return {storage.data(), size}; }
};

/// Type and payload size of the header are taken from the message.
/// @param sequence number of the frame in its direction
FrameBytes encode_frame(const Message& message, std::uint32_t session, std::uint64_t sequence,
                        std::int64_t send_time_ns);

/// Takes the bytes of a stream as they come and gives whole, checked frames back. Everything in the
/// header is checked as soon as the header is there, before any byte of the payload is stored.
/// After an error the stream cannot be trusted: close it.
class FrameReader {
 public:
  /// Takes bytes off the front of `bytes` until a frame is complete or none is left; call until it
  /// returns nothing. Throws ProtocolError (VersionMismatch for another version).
  std::optional<Frame> read(std::span<const std::uint8_t>& bytes);

  /// Whether a frame has begun and is not complete.
  bool partial() const noexcept { return filled_ > 0; }
  /// The bytes of the last frame, or, when one has begun or was not valid, what there is of it;
  /// until the next read().
  std::span<const std::uint8_t> bytes() const noexcept {
    return std::span(frame_).first(partial() ? filled_ : last_size_);
  }

 private:
  bool fill(std::span<const std::uint8_t>& bytes, std::size_t wanted) noexcept;
  void check_header();

  std::array<std::uint8_t, kHeaderSize + kLargestPayload> frame_;
  std::size_t filled_ = 0;
  std::size_t last_size_ = 0;
  Header header_;
  std::uint32_t checksum_ = 0;
};

}  // namespace irdm::wire
