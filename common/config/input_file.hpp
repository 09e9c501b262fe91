#pragma once

#include <filesystem>

namespace irdm {

/// Throws Error where `path` is no file: that there is none, or that it is a folder.
void require_file(const std::filesystem::path& path);

}  // namespace irdm
