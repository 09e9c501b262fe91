#include <iostream>
#include <memory>
#include <string>

#include "common/error.hpp"
#include "common/program/program.hpp"
#include "common/program/stop_signal.hpp"
#include "device_bridge/command/command.hpp"
#include "device_bridge/link/link_probe.hpp"
#include "device_bridge/link/link_verdict.hpp"

namespace irdm::bridge {
namespace {

struct CheckLinkOptions {
  std::string config;
  std::string server;
  double duration = 10.0;
};

int check_link(const CheckLinkOptions& options) {
  StopSignal stop_signal;
  BridgeConfig config;
  if (!options.config.empty()) config = load_bridge_config(options.config);
  if (!options.server.empty()) config.server = parse_server_address(options.server, "--server");
  if (!config.server) {
    throw Error("check-link", "no server is named",
                "give --server HOST:PORT, or --config with the key bridge.server");
  }
  const LinkMeasurement measured = probe_link(config, options.duration, stop_signal);
  std::cout << to_text(measured) << std::flush;
  return judge(measured).grade == LinkGrade::kBad ? 1 : 0;
}

}  // namespace

Command add_check_link_command(CLI::App& app) {
  auto options = std::make_shared<CheckLinkOptions>();
  CLI::App* command =
      app.add_subcommand("check-link", "Measures the link to a running server and judges it");
  command->add_option("--config", options->config,
                      "Bridge's configuration: server, key, rate and scheduling");
  command->add_option("--server", options->server,
                      "HOST:PORT of irdm-server, instead of the configured one");
  command->add_option("--duration", options->duration, "Seconds to measure (default: 10)")
      ->check(positive_number());
  return [options] { return check_link(*options); };
}

}  // namespace irdm::bridge
