#pragma once

#include <filesystem>
#include <vector>

namespace irdm::precompute {

/// Before anything is computed. Throws Error when the output is a folder, would lie in none, or is
/// one of the inputs.
void check_output(const std::filesystem::path& output,
                  const std::vector<std::filesystem::path>& inputs);

}  // namespace irdm::precompute
