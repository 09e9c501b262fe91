#pragma once

#include "common/program/program.hpp"

namespace irdm {

/// Adds the options of irdm-server to a command line. Returns the command that runs the server, or
/// plays a recorded run, once they are parsed.
Command add_server_command(CLI::App& app);

}  // namespace irdm
