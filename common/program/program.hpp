#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

/// The frame that the mains share: exit 0 on success, 1 on a failure said in one line on stderr,
/// 2 on wrong usage.
namespace irdm {

/// Of an option: a finite number above zero. (CLI11's own check lets "nan" through.)
CLI::Validator positive_number();

/// Adds --version, parses the command line and runs `body`; returns the exit status. An exception
/// out of `body` becomes one line on stderr, `NAME: error: WHAT`, and status 1.
int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body);

}  // namespace irdm
