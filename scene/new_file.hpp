#pragma once

#include <filesystem>
#include <string>

namespace irdm {

/// Writes STEM-1ENDING into a folder, or the next number that no file has. It gets its name when it
/// is whole, and takes nobody else's. Returns the name. Throws Error, and leaves nothing then.
std::string write_new_file(const std::filesystem::path& folder, const std::string& stem,
                           const std::string& ending, const std::string& text);

}  // namespace irdm
