#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/wire/aes_gcm.hpp"
#include "common/wire/replay_window.hpp"

namespace irdm::wire {

/// A datagram: session u32, number u64, sealed text, tag. Header and nonce are the same 12 bytes.
inline constexpr std::size_t kDatagramHeaderSize = AesGcm::kNonceSize;
/// No datagram is larger: it goes through every path of IP unbroken, tunnels included.
inline constexpr std::size_t kLargestDatagram = 1200;
inline constexpr std::size_t kLargestText =
    kLargestDatagram - kDatagramHeaderSize - AesGcm::kTagSize;

/// Of one session, one key a direction.
struct DatagramKeys {
  AesGcm::Key to_server = {};
  AesGcm::Key to_bridge = {};
};
enum class DatagramEnd { kServer, kBridge };

/// What became of a datagram that has come.
enum class DatagramVerdict {
  kMessage,   ///< a whole message
  kOpened,    ///< it is the peer's, and no whole message yet
  kForeign,   ///< of another session, from elsewhere, or no datagram of ours at all
  kForged,    ///< its tag is not right: spoilt, or not from the peer
  kReplayed,  ///< it came before, or is too old to tell
};

/// The session that a datagram says it is of, to find its channel; 0, which no session has, when it
/// is too short or too long to be one.
std::uint32_t session_of(std::span<const std::uint8_t> datagram) noexcept;

/// Seals and opens the datagrams of one end of a session. Pure: knows no socket and no clock;
/// allocates nothing after it was made. One thread at a time.
class DatagramChannel {
 public:
  /// @param session the same at both ends, not 0
  DatagramChannel(const DatagramKeys& keys, DatagramEnd end, std::uint32_t session);

  /// The number of the next datagram.
  std::uint64_t next_number() const noexcept { return next_number_; }
  /// A datagram with this text; valid until the next call. Empty where OpenSSL fails.
  /// @param text at most kLargestText bytes
  std::span<const std::uint8_t> seal(std::span<const std::uint8_t> text) noexcept;

  struct Opened {
    DatagramVerdict verdict = DatagramVerdict::kForeign;  ///< kOpened: the rest means something
    std::uint64_t number = 0;
    bool newest = false;                      ///< none with a higher number has come
    std::span<const std::uint8_t> text = {};  ///< valid until the next call
  };
  /// Whatever the bytes are.
  Opened open(std::span<const std::uint8_t> datagram) noexcept;

 private:
  std::uint32_t session_;
  AesGcm sealer_;
  AesGcm opener_;
  std::uint64_t next_number_ = 0;
  ReplayWindow window_;
  std::array<std::uint8_t, kLargestDatagram> sealed_{};
  std::array<std::uint8_t, kLargestText> opened_{};
};

}  // namespace irdm::wire
