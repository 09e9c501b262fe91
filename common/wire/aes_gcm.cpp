#include "common/wire/aes_gcm.hpp"

#include <openssl/evp.h>

#include <stdexcept>

namespace irdm::wire {

void AesGcm::Free::operator()(evp_cipher_ctx_st* context) const noexcept {
  EVP_CIPHER_CTX_free(context);
}

AesGcm::AesGcm(Use use, const Key& key) : context_(EVP_CIPHER_CTX_new()) {
  const int encrypts = use == Use::kSeal ? 1 : 0;
  if (!context_ || EVP_CipherInit_ex(context_.get(), EVP_aes_128_gcm(), nullptr, key.data(),
                                     nullptr, encrypts) != 1) {
    throw std::runtime_error("OpenSSL cannot do AES-128-GCM");
  }
}

// GCM is a stream cipher: as many bytes come out as went in.
bool AesGcm::run(std::span<const std::uint8_t, kNonceSize> nonce,
                 std::span<const std::uint8_t> clear, std::span<std::uint8_t> text) noexcept {
  constexpr int kSameUse = -1;
  EVP_CIPHER_CTX* const context = context_.get();
  int size = 0;
  return EVP_CipherInit_ex(context, nullptr, nullptr, nullptr, nonce.data(), kSameUse) == 1 &&
         EVP_CipherUpdate(context, nullptr, &size, clear.data(), static_cast<int>(clear.size())) ==
             1 &&
         EVP_CipherUpdate(context, text.data(), &size, text.data(),
                          static_cast<int>(text.size())) == 1;
}

bool AesGcm::seal(std::span<const std::uint8_t, kNonceSize> nonce,
                  std::span<const std::uint8_t> clear, std::span<std::uint8_t> text,
                  std::span<std::uint8_t, kTagSize> tag) noexcept {
  std::uint8_t nothing = 0;
  int size = 0;
  return run(nonce, clear, text) && EVP_CipherFinal_ex(context_.get(), &nothing, &size) == 1 &&
         EVP_CIPHER_CTX_ctrl(context_.get(), EVP_CTRL_AEAD_GET_TAG, kTagSize, tag.data()) == 1;
}

bool AesGcm::open(std::span<const std::uint8_t, kNonceSize> nonce,
                  std::span<const std::uint8_t> clear, std::span<std::uint8_t> text,
                  std::span<const std::uint8_t, kTagSize> tag) noexcept {
  std::array<std::uint8_t, kTagSize> expected{};
  std::uint8_t nothing = 0;
  int size = 0;
  for (std::size_t i = 0; i < kTagSize; ++i) expected[i] = tag[i];
  return run(nonce, clear, text) &&
         EVP_CIPHER_CTX_ctrl(context_.get(), EVP_CTRL_AEAD_SET_TAG, kTagSize, expected.data()) ==
             1 &&
         EVP_CipherFinal_ex(context_.get(), &nothing, &size) == 1;
}

}  // namespace irdm::wire
