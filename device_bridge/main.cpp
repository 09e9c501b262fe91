#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "common/hdf5/handle.hpp"
#include "device_bridge/command/command.hpp"

using namespace irdm;

int main(int argc, char** argv) {
  hdf5::leave_files_at_exit();
  spdlog::set_default_logger(spdlog::stderr_color_mt("irdm-bridge"));
  // A further command is one file in device_bridge/command and one line here.
  return run_commands(
      "irdm-bridge",
      "Servo loop of the haptic device: relays stylus and force between device and server", argc,
      argv, bridge::add_run_command,
      {{"check-link", bridge::add_check_link_command},
       {"commission", bridge::add_commission_command},
       {"doctor", bridge::add_doctor_command}});
}
