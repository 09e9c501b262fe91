#pragma once

#include <filesystem>

namespace irdm {

/// The name under which this process writes a file until it is complete: NAME.part-PID, beside it.
/// Removes what processes of this machine that were killed have left of the same file; what a
/// living one writes stays.
std::filesystem::path fresh_part_name(const std::filesystem::path& path);

}  // namespace irdm
