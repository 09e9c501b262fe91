#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <memory>

#include "common/error.hpp"
#include "common/process/part_name.hpp"
#include "precompute/blas_kernel.hpp"
#include "precompute/command/command.hpp"
#include "precompute/compress/compress_model.hpp"
#include "precompute/process/signal_cleanup.hpp"

namespace irdm::precompute {
namespace {

struct CompressOptions {
  std::string input;
  std::string output;
  CompressSettings settings;
  int threads = 0;
};

std::string text(const CompressionSummary& summary) {
  char line[512];
  std::snprintf(line, sizeof line,
                "%.4g MB instead of %.4g MB, %.4g times smaller; %d steps as they are, %d shapes, "
                "%d poles; error measured on %d columns: %.3g %% of displacement at most (%.3g %% "
                "rms), %.3g %% of the force on a held node",
                summary.output_bytes / 1e6, summary.input_bytes / 1e6,
                summary.input_bytes / summary.output_bytes, summary.fir_steps, summary.shapes,
                summary.poles, summary.error.measured_columns, 100.0 * summary.error.displacement,
                100.0 * summary.error.displacement_rms, 100.0 * summary.error.force);
  return line;
}

int compress(const CompressOptions& options) {
  const Console console{std::cout, ::isatty(STDOUT_FILENO) != 0};
  set_blas_threads(options.threads);
  std::error_code ignored;
  if (std::filesystem::equivalent(options.input, options.output, ignored)) {
    throw Error(options.output, "is the input itself", "give the output another name");
  }
  const std::filesystem::path temporary = fresh_part_name(options.output);
  const SignalCleanup cleanup({.remove = temporary});
  const CompressionSummary summary =
      compress_model(options.input, options.output, temporary, options.settings, console);
  console.line(options.output + ": " + text(summary));
  return 0;
}

}  // namespace

Command add_compress_command(CLI::App& app) {
  auto options = std::make_shared<CompressOptions>();
  CLI::App* command = app.add_subcommand(
      "compress", "Makes dense R small, wherever it came from, for engine = \"compressed\"");
  command->add_option("model", options->input, "Model file with dense R (HDF5)")->required();
  command->add_option("-o,--output", options->output, "Model file to write (HDF5)")->required();
  command
      ->add_option(
          "--error", options->settings.error,
          "Largest error, as a share: of each column of R, and of the force on a held node")
      ->capture_default_str()
      ->check(CLI::Range(1e-4, 0.5));
  command
      ->add_option("--fir-steps", options->settings.fir_steps,
                   "Steps of R that are kept as they are (default: 16, more where it takes more)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--early-steps")
      ->group("")
      ->check(CLI::Validator([](const std::string&) { return std::string("is named --fir-steps"); },
                             ""));
  command->add_option("--threads", options->threads, "Threads of the BLAS (default: all cores)")
      ->check(CLI::Range(1, 1024));
  return [options] { return compress(*options); };
}

}  // namespace irdm::precompute
