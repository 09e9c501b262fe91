#pragma once

#include <cstdint>
#include <filesystem>

namespace irdm {

/// Largest configuration, scene and other small text file that is read [byte].
inline constexpr std::uintmax_t kMostConfigBytes = 1 << 20;

/// Throws Error where `path` is no regular file: that there is none, that it is a folder, or that
/// it is something whose end may never come, such as a pipe.
void require_file(const std::filesystem::path& path);
/// Throws Error, too, where the file is larger than `most` bytes.
void require_file(const std::filesystem::path& path, std::uintmax_t most);

}  // namespace irdm
