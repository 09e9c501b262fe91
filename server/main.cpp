#include "common/hdf5/handle.hpp"
#include "server/command.hpp"

int main(int argc, char** argv) {
  irdm::hdf5::leave_files_at_exit();
  irdm::wait_passively_in_openmp(argv);
  return irdm::run_commands("irdm-server",
                            "Renders a soft, free-floating object to force-feedback styluses.",
                            argc, argv, irdm::add_server_command, {});
}
