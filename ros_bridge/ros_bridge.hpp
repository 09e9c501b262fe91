#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace irdm::ros {

/// Adds the options of irdm-ros-bridge to a command line. Returns what it does once they are
/// parsed: its value is the exit status, its errors are thrown.
std::function<int()> add_options(CLI::App& app);

}  // namespace irdm::ros
