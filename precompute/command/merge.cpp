#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <memory>

#include "common/process/part_name.hpp"
#include "precompute/columns/assemble.hpp"
#include "precompute/command/command.hpp"
#include "precompute/process/signal_cleanup.hpp"

namespace irdm::precompute {
namespace {

struct MergeOptions {
  std::vector<std::string> parts;
  std::string output;
};

int merge(const MergeOptions& options) {
  const Console console{std::cout, ::isatty(STDOUT_FILENO) != 0};
  const std::vector<std::filesystem::path> parts(options.parts.begin(), options.parts.end());
  const std::filesystem::path temporary = fresh_part_name(options.output);
  const SignalCleanup cleanup({.remove = temporary});
  const double left = assemble(parts, options.output, temporary, console);
  char text[64];
  std::snprintf(text, sizeof text, "%.4g", 100.0 * left);
  console.line(options.output + ": R of " + std::to_string(parts.size()) + " parts, " +
               std::to_string(std::filesystem::file_size(options.output)) + " bytes, " + text +
               " % left at the last steps");
  return 0;
}

}  // namespace

Command add_merge_command(CLI::App& app) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command =
      app.add_subcommand("merge", "Joins slices of R, made with --columns, into one model file");
  command->add_option("parts", options->parts, "Files that --columns made, in any order")
      ->required();
  command->add_option("-o,--output", options->output, "Model file to write (HDF5)")->required();
  return [options] { return merge(*options); };
}

}  // namespace irdm::precompute
