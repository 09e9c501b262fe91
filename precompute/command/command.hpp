#pragma once

#include "common/program/program.hpp"

/// The commands of irdm-precompute. Each function adds a command's options to the command line and
/// returns what it does once they are parsed: its value is the exit status, its errors are thrown.
namespace irdm::precompute {

/// Without a word for it: CONFIG.toml -o MODEL.h5 computes a model file.
Command add_compute_command(CLI::App& app);

/// merge PART... -o MODEL.h5 joins slices of R that --columns made.
Command add_merge_command(CLI::App& app);

/// check MODEL.h5: a table with a verdict a line (docs/check.md); status 1 when a line fails.
Command add_check_command(CLI::App& app);

/// compress IN.h5 -o OUT.h5: dense R as a small compressed response (docs/theory.md); status 1
/// where the error that is asked for cannot be reached.
Command add_compress_command(CLI::App& app);

}  // namespace irdm::precompute
