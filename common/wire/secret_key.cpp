#include "common/wire/secret_key.hpp"

#include <openssl/rand.h>
#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "common/error.hpp"

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

namespace {

namespace fs = std::filesystem;

void check_permissions(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) {
    throw Error(name, "cannot read the key: there is no such file",
                "make one with: (umask 077; openssl rand -hex 32 > " + name + ")");
  }
  if (!fs::is_regular_file(status)) throw Error(name, "is not a file", "name a key file");
  constexpr fs::perms kOthers = fs::perms::group_all | fs::perms::others_all;
  if ((status.permissions() & kOthers) != fs::perms::none) {
    throw Error(name, "is a key that others may read or write", "chmod 600 " + name);
  }
}

}  // namespace

SecretKey read_key_file(const fs::path& path) {
  check_permissions(path);
  std::ifstream file(path);
  if (!file) throw Error(path.string(), "cannot read the key", "check who owns the file");
  std::string digits;
  std::string more;
  file >> digits >> more;
  SecretKey key{};
  bool good = digits.size() == 2 * key.size() && more.empty();
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
