#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace irdm::wire {

/// What a connection shows to whoever listens in.
enum class TapKind : std::uint8_t {
  kReceived = 0,   ///< a whole, checked frame
  kSent = 1,       ///< a whole frame
  kSpoilt = 2,     ///< bytes that were received and are no valid frame, as far as they were read
  kOpened = 3,     ///< a connection has begun: the peer's address
  kViolation = 4,  ///< the peer broke the protocol: how, in words
  kClosed = 5,     ///< the connection has ended: why, in words
};

/// Listens in on connections, all of one thread.
class FrameTap {
 public:
  FrameTap() = default;
  FrameTap(const FrameTap&) = delete;
  FrameTap& operator=(const FrameTap&) = delete;
  virtual ~FrameTap() = default;

  /// A connection begins; its number.
  virtual std::uint32_t open(std::string_view peer) noexcept = 0;
  /// @param bytes valid during the call
  virtual void see(TapKind kind, std::uint32_t connection,
                   std::span<const std::uint8_t> bytes) noexcept = 0;
};

}  // namespace irdm::wire
