#include <cstdlib>
#include <map>

#include "common/program/program.hpp"
#include "replay/command/command.hpp"

using namespace irdm;

int main(int argc, char** argv) {
  // The factors of a reference are too small for more, and its sums should not depend on them. Read
  // when the program is loaded, that is when the next line starts it again.
  ::setenv("OPENBLAS_NUM_THREADS", "1", 0);
  wait_passively_in_openmp(argv);
  CLI::App app("Makes a recorded run again from its trace, and compares runs.", "irdm-replay");
  app.require_subcommand(0, 1);
  const replay::Command replay = replay::add_replay_command(app);
  // A further command is one file in replay/command and one line here.
  const std::map<std::string, replay::Command> commands{
      {"compare", replay::add_compare_command(app)},
  };

  return run_program(app, argc, argv, [&] {
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? replay() : commands.at(chosen.front()->get_name())();
  });
}
