#include <unistd.h>

#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "precompute/blas_kernel.hpp"
#include "precompute/command/command.hpp"
#include "precompute/precompute.hpp"

namespace irdm::precompute {
namespace {

struct ComputeOptions {
  std::string config;
  std::string output;
  std::string method;
  std::string storage;
  std::string columns;
  int threads = 0;
};

// A wrong one is wrong usage.
CLI::Validator column_range_check() {
  const auto check = [](const std::string& text) -> std::string {
    try {
      column_range_from_text(text);
      return "";
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  };
  return {check, "A:B", "column_range"};
}

int compute(const ComputeOptions& options) {
  PrecomputeConfig config = load_config(options.config);
  if (!options.method.empty()) config.response.method = method_from_word(options.method);
  if (!options.storage.empty()) config.response.storage = storage_from_word(options.storage);
  config.threads = options.threads;
  set_blas_threads(options.threads);
  std::optional<ColumnRange> slice;
  if (!options.columns.empty()) slice = column_range_from_text(options.columns);
  const Ranks ranks;
  std::ostringstream unheard;
  const Console console{ranks.rank() == 0 ? std::cout : unheard, ::isatty(STDOUT_FILENO) != 0};
  const Summary summary = precompute_model(config, options.output, console, slice, ranks);
  console.line(options.output + ":\n" + format_summary(summary));
  return 0;
}

}  // namespace

Command add_compute_command(CLI::App& app) {
  auto options = std::make_shared<ComputeOptions>();
  CLI::Option* config =
      app.add_option("config", options->config, "Configuration file (TOML); required");
  CLI::Option* output =
      app.add_option("-o,--output", options->output, "Model file to write (HDF5); required");
  app.add_option("--method", options->method, "How R is obtained; overrides response.method")
      ->check(CLI::IsMember({"modal", "time-stepping"}));
  app.add_option("--storage", options->storage, "Form of R in the file; overrides response.storage")
      ->check(CLI::IsMember({"modal", "dense", "both"}));
  app.add_option("--columns", options->columns,
                 "A:B, only columns A <= b < B of dense R: the output is a part for merge")
      ->check(column_range_check());
  app.add_option("--threads", options->threads, "Threads to compute with (default: all cores)")
      ->check(CLI::Range(1, 1024));
  // Required here and not by the options, so that another command can be given instead.
  app.parse_complete_callback([&app, config, output] {
    if (!app.get_subcommands().empty()) return;
    if (config->empty()) throw CLI::RequiredError("config");
    if (output->empty()) throw CLI::RequiredError("--output");
  });
  return [options] { return compute(*options); };
}

}  // namespace irdm::precompute
