#include "common/wire/secret_key.hpp"

#include <openssl/rand.h>
#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string>

#include "common/error.hpp"
#include "common/secret/secret_file.hpp"

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

SecretKey read_key_file(const std::filesystem::path& path) {
  const std::string digits = read_secret_file(path, {"key", 32});
  SecretKey key{};
  bool good = digits.size() == 2 * key.size();
  for (std::size_t i = 0; good && i < key.size(); ++i) {
    const char* begin = digits.data() + 2 * i;
    const auto [end, error] = std::from_chars(begin, begin + 2, key[i], 16);
    good = error == std::errc() && end == begin + 2;
  }
  if (!good) {
    throw Error(path.string(), "is not a key of 64 hexadecimal digits",
                "make one with: openssl rand -hex 32");
  }
  return key;
}

}  // namespace irdm::wire
