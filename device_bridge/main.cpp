#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <iostream>
#include <limits>
#include <stdexcept>

#include "common/program/program.hpp"
#include "common/program/stop_signal.hpp"
#include "device_bridge/bridge.hpp"
#include "device_bridge/device_registry.hpp"

int main(int argc, char** argv) {
  CLI::App app("Servo loop of the haptic device: relays stylus and force between device and server",
               "irdm-bridge");
  std::string config_path;
  irdm::BridgeOverrides overrides;
  double duration = std::numeric_limits<double>::infinity();
  app.add_option("BRIDGE.toml", config_path, "Configuration: the devices")->required();
  app.add_option("--server", overrides.server, "HOST:PORT of irdm-server");
  app.add_option("--device", overrides.device, "Type of all devices, instead of the configured one")
      ->check(CLI::IsMember(irdm::device_types()));
  app.add_option("--script", overrides.script, "Motion of the virtual stylus (CSV)");
  app.add_option("--duration", duration, "End after this many seconds of session")
      ->check(irdm::positive_number());

  return irdm::run_program(app, argc, argv, [&] {
    irdm::StopSignal stop_signal;
    spdlog::set_default_logger(spdlog::stderr_color_mt("irdm-bridge"));
    const irdm::BridgeConfig config = irdm::load_bridge_config(config_path, overrides);
    const irdm::BridgeReport report = irdm::run_bridge(config, stop_signal, duration);
    if (report.client.sessions > 0) std::cout << irdm::to_text(report) << std::flush;
    if (!report.client.failure.empty()) throw std::runtime_error(report.client.failure);
    return 0;
  });
}
