#include <map>

#include "common/program/program.hpp"
#include "precompute/blas.hpp"
#include "precompute/command/command.hpp"

using namespace irdm;

int main(int argc, char** argv) {
  precompute::use_fast_blas_kernel(argv);
  CLI::App app("Computes the impulse responses of a soft object and writes its model file.",
               "irdm-precompute");
  app.require_subcommand(0, 1);
  const precompute::Command compute = precompute::add_compute_command(app);
  // A further command is one file in precompute/command and one line here.
  const std::map<std::string, precompute::Command> commands{
      {"merge", precompute::add_merge_command(app)},
      {"check", precompute::add_check_command(app)},
      {"compress", precompute::add_compress_command(app)},
  };

  return run_program(app, argc, argv, [&] {
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? compute() : commands.at(chosen.front()->get_name())();
  });
}
