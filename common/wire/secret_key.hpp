#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

namespace irdm::wire {

/// What server and bridge both know and nobody else.
using SecretKey = std::array<std::uint8_t, 32>;

/// Reads a key file: 64 hexadecimal digits, white space around them. It must be readable by its
/// owner alone. Throws Error, which never quotes the content.
SecretKey read_key_file(const std::filesystem::path& path);

}  // namespace irdm::wire
