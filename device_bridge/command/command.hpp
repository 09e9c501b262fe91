#pragma once

#include <CLI/CLI.hpp>
#include <functional>

/// The commands of irdm-bridge. Each function adds a command's options to the command line and
/// returns what it does once they are parsed: its value is the exit status, its errors are thrown.
namespace irdm::bridge {

using Command = std::function<int()>;

/// Without a word for it: BRIDGE.toml runs the servo loop.
Command add_run_command(CLI::App& app);

/// check-link measures the link to a running server; status 1 when a stylus would not arm on it.
Command add_check_link_command(CLI::App& app);

}  // namespace irdm::bridge
