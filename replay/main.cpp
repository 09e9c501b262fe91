#include <cstdlib>

#include "common/hdf5/handle.hpp"
#include "replay/command/command.hpp"

using namespace irdm;

int main(int argc, char** argv) {
  hdf5::leave_files_at_exit();
  // The factors of a reference are too small for more, and its sums should not depend on them. Read
  // when the program is loaded, that is when the next line starts it again.
  ::setenv("OPENBLAS_NUM_THREADS", "1", 0);
  wait_passively_in_openmp(argv);
  // A further command is one file in replay/command and one line here.
  return run_commands("irdm-replay",
                      "Makes a recorded run again from its trace, and compares runs.", argc, argv,
                      replay::add_replay_command, {{"compare", replay::add_compare_command}});
}
