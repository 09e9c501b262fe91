#include "precompute/command/command.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "common/error.hpp"
#include "common/process/signal_cleanup.hpp"
#include "common/process/temporary_files.hpp"
#include "common/program/program.hpp"
#include "precompute/blas.hpp"
#include "precompute/check/check_model.hpp"
#include "precompute/columns/assemble.hpp"
#include "precompute/compress/compress_model.hpp"
#include "precompute/precompute.hpp"

namespace irdm::precompute {
namespace {

// Before anything is computed. Throws Error when the output is a folder, would lie in none, or is
// one of the inputs.
void check_output(const std::filesystem::path& output,
                  const std::vector<std::filesystem::path>& inputs) {
  std::error_code ignored;
  if (std::filesystem::is_directory(output, ignored)) {
    throw Error(output.string(), "is a folder", "give the output the name of a file");
  }
  if (!std::filesystem::is_directory(std::filesystem::absolute(output).parent_path(), ignored)) {
    throw Error(output.string(), "cannot be created",
                "check that the folder exists and is writable");
  }
  for (const std::filesystem::path& input : inputs) {
    if (!std::filesystem::equivalent(input, output, ignored)) continue;
    throw Error(output.string(), "is the input itself", "give the output another name");
  }
}

struct CheckCommandOptions {
  std::string model;
  CheckOptions check;
};

int check(const CheckCommandOptions& options) {
  const Console console{std::cout, ::isatty(STDOUT_FILENO) != 0};
  set_blas_threads(0);
  const Report report = check_model(options.model, options.check, console);
  console.line(options.model + ":\n" + format_report(report));
  const std::string failed = failed_lines(report);
  if (!failed.empty()) throw Error(options.model, "fails: " + failed, "see docs/check.md");
  return 0;
}

}  // namespace

Command add_check_command(CLI::App& app) {
  auto options = std::make_shared<CheckCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "check", "Says whether a model file is physically sound and safe to render");
  Hand& hand = options->check.hand;
  const CLI::Validator not_negative = CLI::Range(0.0, 1e9);
  command->add_option("model", options->model, "Model file (HDF5)")->required();
  command->add_option("--hand-mass", hand.mass, "Of hand and stylus [kg]")
      ->capture_default_str()
      ->check(positive_number());
  command->add_option("--hand-damping", hand.damping, "Of the hand [N s/m]")
      ->capture_default_str()
      ->check(not_negative);
  command->add_option("--hand-stiffness", hand.stiffness, "Of the hand [N/m]")
      ->capture_default_str()
      ->check(positive_number());
  command
      ->add_option("--delay", options->check.delay,
                   "Between stylus and server, each way [s], rounded up to whole steps (default: "
                   "one step)")
      ->check(not_negative);
  command
      ->add_option("--coupling", options->check.coupling,
                   "Virtual coupling that is going to be used [N/m]: not stable is a failure")
      ->check(positive_number());
  return [options] { return check(*options); };
}

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
  check_output(options.output, {options.input});
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
  const auto refuse = [](const std::string&) {
    throw CLI::ValidationError("--early-steps", "is named --fir-steps");
  };
  command->add_option_function<std::string>("--early-steps", refuse)->group("");
  command->add_option("--threads", options->threads, "Threads of the BLAS (default: all cores)")
      ->check(CLI::Range(1, 1024));
  return [options] { return compress(*options); };
}

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
  std::vector<std::filesystem::path> inputs{options.config};
  if (const auto* mesh = std::get_if<std::filesystem::path>(&config.mesh.source)) {
    inputs.push_back(*mesh);
  }
  check_output(options.output, inputs);
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

namespace {

struct MergeOptions {
  std::vector<std::string> parts;
  std::string output;
};

int merge(const MergeOptions& options) {
  const Console console{std::cout, ::isatty(STDOUT_FILENO) != 0};
  const std::vector<std::filesystem::path> parts(options.parts.begin(), options.parts.end());
  check_output(options.output, parts);
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
