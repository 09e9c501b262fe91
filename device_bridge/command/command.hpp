#pragma once

#include "common/program/program.hpp"

/// The commands of irdm-bridge. Each function adds a command's options to the command line and
/// returns what it does once they are parsed: its value is the exit status, its errors are thrown.
namespace irdm::bridge {

/// Without a word for it: BRIDGE.toml runs the bridge.
Command add_run_command(CLI::App& app);

/// doctor [--config BRIDGE.toml]: a line for each thing that newcomers stumble over; status 1 when
/// one of them is a problem.
Command add_doctor_command(CLI::App& app);

/// commission --config BRIDGE.toml: leads through the first hour with a device, and writes what was
/// found into a file; status 1 unless all steps passed.
Command add_commission_command(CLI::App& app);

/// check-link measures the link to a running server; status 1 when a stylus would not arm on it.
Command add_check_link_command(CLI::App& app);

}  // namespace irdm::bridge
