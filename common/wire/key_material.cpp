#include "common/wire/key_material.hpp"

#include <openssl/rand.h>

#include <algorithm>
#include <stdexcept>

namespace irdm::wire {

KeyMaterial random_material() {
  KeyMaterial material;
  if (RAND_bytes(material.data(), static_cast<int>(material.size())) != 1) {
    throw std::runtime_error("OpenSSL has no random bytes");
  }
  return material;
}

DatagramKeys keys_of(const KeyMaterial& material) noexcept {
  DatagramKeys keys;
  const auto half = material.begin() + AesGcm::kKeySize;
  std::copy(material.begin(), half, keys.to_server.begin());
  std::copy(half, material.end(), keys.to_bridge.begin());
  return keys;
}

}  // namespace irdm::wire
