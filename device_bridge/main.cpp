#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <map>

#include "common/program/program.hpp"
#include "device_bridge/command/command.hpp"

using namespace irdm;

int main(int argc, char** argv) {
  CLI::App app("Servo loop of the haptic device: relays stylus and force between device and server",
               "irdm-bridge");
  app.require_subcommand(0, 1);
  const bridge::Command run = bridge::add_run_command(app);
  // A further command is one file in device_bridge/command and one line here.
  const std::map<std::string, bridge::Command> commands{
      {"check-link", bridge::add_check_link_command(app)},
      {"commission", bridge::add_commission_command(app)},
      {"doctor", bridge::add_doctor_command(app)},
  };

  return run_program(app, argc, argv, [&] {
    spdlog::set_default_logger(spdlog::stderr_color_mt("irdm-bridge"));
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? run() : commands.at(chosen.front()->get_name())();
  });
}
