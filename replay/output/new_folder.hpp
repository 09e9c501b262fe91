#pragma once

#include <filesystem>

namespace irdm::replay {

/// Makes a folder where there is none, and throws Error when there is one with something in it.
void make_new_folder(const std::filesystem::path& folder);

}  // namespace irdm::replay
