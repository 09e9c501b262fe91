#include <spdlog/spdlog.h>

#include <iostream>
#include <memory>
#include <optional>

#include "common/error.hpp"
#include "device_bridge/command/command.hpp"
#include "device_bridge/doctor/examine.hpp"

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
