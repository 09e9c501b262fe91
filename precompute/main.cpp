#include "common/hdf5/handle.hpp"
#include "precompute/blas.hpp"
#include "precompute/command/command.hpp"

using namespace irdm;

int main(int argc, char** argv) {
  hdf5::leave_files_at_exit();
  precompute::use_fast_blas_kernel(argv);
  // A further command is one file in precompute/command and one line here.
  return run_commands("irdm-precompute",
                      "Computes the impulse responses of a soft object and writes its model file.",
                      argc, argv, precompute::add_compute_command,
                      {{"merge", precompute::add_merge_command},
                       {"check", precompute::add_check_command},
                       {"compress", precompute::add_compress_command}});
}
