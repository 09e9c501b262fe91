#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace irdm::precompute {

/// How a child process ended.
enum class ChildEnd { kSuccess, kFailure, kNotFound, kTimeout };

/// Runs a program, looked up in PATH, without a shell: no input, its output and errors into
/// `log_file`. Waits for its end; after `time_limit_s` it is killed.
/// @param arguments without the program's name
/// @param folder working directory of the child
ChildEnd run_child(const std::string& program, const std::vector<std::string>& arguments,
                   const std::filesystem::path& folder, const std::filesystem::path& log_file,
                   double time_limit_s);

}  // namespace irdm::precompute
