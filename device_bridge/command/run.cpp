#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>

#include "common/program/program.hpp"
#include "common/program/stop_signal.hpp"
#include "device_bridge/bridge.hpp"
#include "device_bridge/command/command.hpp"
#include "device_bridge/device_registry.hpp"

namespace irdm::bridge {
namespace {

struct RunOptions {
  std::string config;
  BridgeOverrides overrides;
  double duration = std::numeric_limits<double>::infinity();
};

int run(const RunOptions& options) {
  StopSignal stop_signal;
  const BridgeConfig config = load_bridge_config(options.config, options.overrides);
  const BridgeReport report = run_bridge(config, stop_signal, options.duration);
  if (report.client.sessions > 0) std::cout << to_text(report) << std::flush;
  if (!report.client.failure.empty()) throw std::runtime_error(report.client.failure);
  return 0;
}

}  // namespace

Command add_run_command(CLI::App& app) {
  auto options = std::make_shared<RunOptions>();
  CLI::Option* config =
      app.add_option("BRIDGE.toml", options->config, "Configuration: the devices; required");
  app.add_option("--server", options->overrides.server, "HOST:PORT of irdm-server");
  app.add_option("--device", options->overrides.device,
                 "Type of all devices, instead of the configured one")
      ->check(CLI::IsMember(device_types()));
  app.add_option("--script", options->overrides.script, "Motion of the virtual stylus (CSV)");
  app.add_option("--duration", options->duration, "End after this many seconds of session")
      ->check(positive_number());
  // Required here and not by the option, so that another command can be given instead.
  app.parse_complete_callback([&app, config] {
    if (app.get_subcommands().empty() && config->empty()) throw CLI::RequiredError("BRIDGE.toml");
  });
  return [options] { return run(*options); };
}

}  // namespace irdm::bridge
