#include "common/wire/datagram_channel.hpp"

#include <openssl/evp.h>
#include <algorithm>
#include <stdexcept>

#include "common/wire/bytes.hpp"

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

namespace {

constexpr std::size_t kSmallestDatagram = kDatagramHeaderSize + AesGcm::kTagSize;

}  // namespace

std::uint32_t session_of(std::span<const std::uint8_t> datagram) noexcept {
  if (datagram.size() < kSmallestDatagram || datagram.size() > kLargestDatagram) return 0;
  return ByteReader(datagram).get<std::uint32_t>();
}

DatagramChannel::DatagramChannel(const DatagramKeys& keys, DatagramEnd end, std::uint32_t session)
    : session_(session),
      sealer_(AesGcm::Use::kSeal, end == DatagramEnd::kBridge ? keys.to_server : keys.to_bridge),
      opener_(AesGcm::Use::kOpen, end == DatagramEnd::kBridge ? keys.to_bridge : keys.to_server) {}

std::span<const std::uint8_t> DatagramChannel::seal(std::span<const std::uint8_t> text) noexcept {
  if (text.size() > kLargestText) return {};
  const std::span<std::uint8_t> datagram =
      std::span(sealed_).first(kSmallestDatagram + text.size());
  ByteWriter header(datagram.first<kDatagramHeaderSize>());
  header.put(session_);
  header.put(next_number_++);
  const std::span<std::uint8_t> body = datagram.subspan(kDatagramHeaderSize, text.size());
  std::copy(text.begin(), text.end(), body.begin());
  const std::span<const std::uint8_t, kDatagramHeaderSize> nonce =
      datagram.first<kDatagramHeaderSize>();
  if (!sealer_.seal(nonce, nonce, body, datagram.last<AesGcm::kTagSize>())) return {};
  return datagram;
}

// Nothing of it is believed before its tag was checked, not even its number.
DatagramChannel::Opened DatagramChannel::open(std::span<const std::uint8_t> datagram) noexcept {
  if (session_of(datagram) != session_) return {};
  const std::span<const std::uint8_t, kDatagramHeaderSize> nonce =
      datagram.first<kDatagramHeaderSize>();
  const std::span<const std::uint8_t> body =
      datagram.subspan(kDatagramHeaderSize, datagram.size() - kSmallestDatagram);
  const std::span<std::uint8_t> text = std::span(opened_).first(body.size());
  std::copy(body.begin(), body.end(), text.begin());
  if (!opener_.open(nonce, nonce, text, datagram.last<AesGcm::kTagSize>())) {
    return {.verdict = DatagramVerdict::kForged};
  }
  ByteReader header(nonce);
  header.skip(sizeof session_);
  const auto number = header.get<std::uint64_t>();
  if (!window_.fresh(number)) return {.verdict = DatagramVerdict::kReplayed};
  return {.verdict = DatagramVerdict::kOpened,
          .number = number,
          .newest = window_.take(number),
          .text = text};
}

}  // namespace irdm::wire
