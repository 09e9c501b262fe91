#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "common/wire/datagram_channel.hpp"

namespace irdm::wire {

/// What the keys of a session's datagrams are made of.
using KeyMaterial = std::array<std::uint8_t, 32>;
static_assert(sizeof(KeyMaterial) == 2 * AesGcm::kKeySize);

/// Not to be guessed. Throws std::runtime_error when OpenSSL has no randomness.
KeyMaterial random_material();
/// First the key to the server, then that to the bridge.
DatagramKeys keys_of(const KeyMaterial& material) noexcept;

/// What server and bridge both know and nobody else.
using SecretKey = std::array<std::uint8_t, 32>;

/// Reads a key file: 64 hexadecimal digits, white space around them, with the permissions that
/// read_secret_file() demands. Throws Error, which never quotes the content.
SecretKey read_key_file(const std::filesystem::path& path);

}  // namespace irdm::wire
