#pragma once

#include "common/program/program.hpp"

namespace irdm::ros {

/// Adds the options of irdm-ros-bridge to a command line. Returns what it does once they are
/// parsed: its value is the exit status, its errors are thrown.
Command add_options(CLI::App& app);

}  // namespace irdm::ros
