#include <sys/prctl.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <cctype>
#include <csignal>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/program/stop_signal.hpp"
#include "device_bridge/command/command.hpp"
#include "device_bridge/commission/commission.hpp"
#include "device_bridge/commission/terminal.hpp"
#include "device_bridge/device_registry.hpp"

namespace irdm::bridge {
namespace {

struct CommissionOptions {
  std::string config;
  BridgeOverrides overrides;
  std::size_t device = 0;
  std::string out;
  bool push = false;
};

BridgeConfig load_one_device(const CommissionOptions& options) {
  BridgeOverrides overrides = options.overrides;
  overrides.commissions = true;
  BridgeConfig config = load_bridge_config(options.config, overrides);
  if (options.device >= config.devices.size()) {
    throw Error("--device",
                "is " + std::to_string(options.device) + ", and there are only " +
                    std::to_string(config.devices.size()),
                "count the [[device]] tables from 0");
  }
  config.devices = {config.devices[options.device]};
  return config;
}

// "commission-Left.toml"; only what is good in any file's name.
std::string file_name(const DeviceConfig& device) {
  std::string name = device.name.empty() ? device.type : device.name;
  for (char& letter : name) {
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0) letter = '-';
  }
  return "commission-" + name + ".toml";
}

// This program again, for the step in which it is killed.
std::vector<std::string> pushing(const CommissionOptions& options) {
  return {"/proc/self/exe", "commission", "--config",
          options.config,   "--device",   std::to_string(options.device),
          "--push"};
}

commission::Report run_commission(const CommissionOptions& options, const BridgeConfig& config,
                                  StopSignal& signal) {
  const DeviceConfig& table = config.devices[0];
  commission::Terminal terminal(signal, STDIN_FILENO, std::cout);
  if (table.type != "virtual") {
    const auto device = make_device(table);
    return commission::commission(config, *device, terminal, pushing(options));
  }
  commission::GuidedStylus stylus(table.hand, table.sensor, table.motors);
  commission::SimulatedPerson person(terminal, stylus);
  return commission::commission(config, stylus, person, {});
}

void write(const std::string& file, const std::string& text, std::ios::openmode mode) {
  std::ofstream stream(file, std::ios::out | mode);
  stream << text << std::flush;
  if (!stream) throw Error(file, "cannot be written", "give another file by --out");
}

int commission_device(const CommissionOptions& options) {
  StopSignal signal;
  std::signal(SIGTSTP, SIG_IGN);  // a process that is suspended takes no force away
  const BridgeConfig config = load_one_device(options);
  if (options.push) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // no force without the person's terminal
    commission::push_until_stopped(config, *make_device(config.devices[0]), signal);
    return 0;
  }
  const std::string file = options.out.empty() ? file_name(config.devices[0]) : options.out;
  write(file, "", std::ios::app);  // one that cannot be written is told before
  const commission::Report report = run_commission(options, config, signal);
  write(file, to_toml(report, file), std::ios::trunc);
  std::cout << '\n' << to_text(report) << "report: " << file << std::endl;
  if (report.signed_off()) return 0;
  throw Error("commission", "not signed off", "do what the report says, and run it again");
}

}  // namespace

Command add_commission_command(CLI::App& app) {
  auto options = std::make_shared<CommissionOptions>();
  CLI::App* command =
      app.add_subcommand("commission", "Leads through the first hour with a device, and reports");
  command->add_option("--config", options->config, "Configuration (BRIDGE.toml)")->required();
  command->add_option("--script", options->overrides.script, "As of the bridge");
  command->add_option("--device", options->device, "Which [[device]], from 0 (default: 0)");
  command->add_option("--out", options->out, "File of the report (default: commission-NAME.toml)");
  command->add_flag("--push", options->push, "Only pushes the handle up, until it is killed")
      ->group("");
  return [options] { return commission_device(*options); };
}

}  // namespace irdm::bridge
