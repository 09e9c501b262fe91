#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
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

}  // namespace irdm::wire
