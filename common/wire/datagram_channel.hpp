#pragma once

#include <algorithm>
#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

struct evp_cipher_ctx_st;

namespace irdm::wire {

/// AES-128-GCM (NIST SP 800-38D) by OpenSSL, under one key and for one use. Its context is made
/// once: sealing and opening allocate nothing. One thread at a time.
class AesGcm {
 public:
  static constexpr std::size_t kKeySize = 16;
  static constexpr std::size_t kNonceSize = 12;
  static constexpr std::size_t kTagSize = 16;
  using Key = std::array<std::uint8_t, kKeySize>;
  enum class Use { kSeal, kOpen };

  /// Throws std::runtime_error when OpenSSL does not play along.
  AesGcm(Use use, const Key& key);

  /// Encrypts `text` in place and writes the tag over it and `clear`, which stays readable. False:
  /// OpenSSL failed, and nothing may be sent.
  /// @param nonce never the same twice under a key
  [[nodiscard]] bool seal(std::span<const std::uint8_t, kNonceSize> nonce,
                          std::span<const std::uint8_t> clear, std::span<std::uint8_t> text,
                          std::span<std::uint8_t, kTagSize> tag) noexcept;
  /// Decrypts `text` in place. False when the tag is not that of these bytes under this key; what
  /// stands in `text` then means nothing.
  [[nodiscard]] bool open(std::span<const std::uint8_t, kNonceSize> nonce,
                          std::span<const std::uint8_t> clear, std::span<std::uint8_t> text,
                          std::span<const std::uint8_t, kTagSize> tag) noexcept;

 private:
  bool run(std::span<const std::uint8_t, kNonceSize> nonce, std::span<const std::uint8_t> clear,
           std::span<std::uint8_t> text) noexcept;

  struct Free {
    void operator()(evp_cipher_ctx_st* context) const noexcept;
  };
  std::unique_ptr<evp_cipher_ctx_st, Free> context_;
};

/// Which numbers have come, so that none counts twice: those up to kWidth below the newest may come
/// late, what is older counts as seen. Pure; allocates nothing.
class ReplayWindow {
 public:
  /// Four styluses with a model a step make 10000 datagrams a second: a tenth of one second;
  /// sixteen, 26 ms. What comes later has been overtaken by newer frames.
  static constexpr std::uint64_t kWidth = 1024;

  /// Whether the number has not been taken and is not too old to tell.
  bool fresh(std::uint64_t number) const noexcept {
    if (!newest_ || number > *newest_) return true;
    return *newest_ - number < kWidth && !seen_[number % kWidth];
  }
  /// Takes a number that is fresh. True when it is the newest.
  bool take(std::uint64_t number) noexcept {
    const bool newest = !newest_ || number > *newest_;
    if (newest) advance(number);
    seen_[number % kWidth] = true;
    return newest;
  }

 private:
  void advance(std::uint64_t number) noexcept {
    const std::uint64_t count = newest_ ? std::min(number - *newest_, kWidth) : kWidth;
    for (std::uint64_t i = 0; i < count; ++i) seen_[(number - i) % kWidth] = false;
    newest_ = number;
  }

  std::optional<std::uint64_t> newest_;
  std::bitset<kWidth> seen_;
};

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
