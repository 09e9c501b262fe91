#pragma once

#include "common/program/program.hpp"

/// The commands of irdm-replay. Each function adds a command's options to the command line and
/// returns what it does once they are parsed: its value is the exit status, its errors are thrown.
namespace irdm::replay {

/// Without a word for it: TRACE.h5 makes a recorded run again (docs/replay.md).
Command add_replay_command(CLI::App& app);

/// compare A.h5 B.h5: how far two runs that --output wrote are apart.
Command add_compare_command(CLI::App& app);

}  // namespace irdm::replay
