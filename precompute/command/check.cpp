#include <unistd.h>

#include <iostream>
#include <memory>

#include "common/error.hpp"
#include "common/program/program.hpp"
#include "precompute/blas_kernel.hpp"
#include "precompute/check/check_model.hpp"
#include "precompute/command/command.hpp"

namespace irdm::precompute {
namespace {

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

}  // namespace irdm::precompute
