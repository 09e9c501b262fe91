#include "device_bridge/command/command.hpp"

#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/error.hpp"
#include "common/program/stop_signal.hpp"
#include "device_bridge/bridge.hpp"
#include "device_bridge/device_registry.hpp"
#include "device_bridge/doctor/examine.hpp"
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

namespace irdm::bridge {
namespace {

struct DoctorOptions {
  std::string config;
  BridgeOverrides overrides;
};

int examine(const DoctorOptions& options) {
  spdlog::set_level(spdlog::level::off);
  std::optional<BridgeConfig> config;
  if (!options.config.empty()) config = load_bridge_config(options.config, options.overrides);
  const doctor::Findings findings = doctor::examine(config);
  std::cout << to_text(findings) << std::flush;
  const int problems = count_problems(findings);
  if (problems > 0) {
    throw Error("doctor", std::to_string(problems) + (problems == 1 ? " problem" : " problems"),
                "see docs/devices.md");
  }
  return 0;
}

}  // namespace

Command add_doctor_command(CLI::App& app) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = app.add_subcommand(
      "doctor", "Says what keeps a bridge from working, and what to do about it");
  CLI::Option* config =
      command->add_option("--config", options->config, "Configuration to look at (BRIDGE.toml)");
  command->add_option("--server", options->overrides.server, "HOST:PORT of irdm-server")
      ->needs(config);
  return [options] { return examine(*options); };
}

}  // namespace irdm::bridge

namespace irdm::bridge {
namespace {

constexpr int kDeviceFault = 3;  // exit status, which irdm-bridge.service does not restart

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
  if (report.device_fault) throw StatusError(kDeviceFault, report.client.failure);
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
  app.add_option(
         "--arm", options->overrides.arm,
         "automatic, or button: no force before a person has pressed a button of the stylus")
      ->check(CLI::IsMember(arm_words()));
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
