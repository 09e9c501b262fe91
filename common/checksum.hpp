#pragma once

#include <filesystem>
#include <string>

namespace irdm {

/// SHA-256 of a file's bytes in lower-case hexadecimal, as the program sha256sum prints it. Throws
/// Error.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace irdm
