#include "device_bridge/doctor/examine.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "common/number_text.hpp"
#include "device_bridge/bridge.hpp"
#include "device_bridge/device_registry.hpp"
#include "device_bridge/doctor/judgements.hpp"
#include "device_bridge/forcedimension/dhd_api.hpp"
#include "device_bridge/forcedimension/dhd_usb.hpp"
#include "device_bridge/haply/haply_device.hpp"
#include "device_bridge/openhaptics/hd_library.hpp"

namespace irdm::doctor {
namespace {

void add(Findings& findings, Findings more) {
  std::move(more.begin(), more.end(), std::back_inserter(findings));
}

template <typename Load>
std::string failure_of(Load load) {
  try {
    load();
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

bool has_type(const std::vector<DeviceConfig>& devices, const std::string& type) {
  return std::any_of(devices.begin(), devices.end(),
                     [&](const DeviceConfig& device) { return device.type == type; });
}

Findings examine_openhaptics(const std::vector<DeviceConfig>& devices) {
  const bool wanted = has_type(devices, "openhaptics");
  const hd::TouchSystem system = hd::look_at_touch_system();
  Findings findings{judge_library("libHD.so", failure_of(hd::library), wanted)};
  add(findings, judge_ports(system, wanted));
  for (const DeviceConfig& device : devices) {
    if (device.type == "openhaptics") findings.push_back(judge_setup(system, device.name));
  }
  return findings;
}

// Drivers; those of no configured device only where there is no configuration.
Findings examine_drivers(const std::optional<BridgeConfig>& config) {
  Findings findings;
  const std::vector<DeviceConfig> devices = config ? config->devices : std::vector<DeviceConfig>{};
  if (!config || has_type(devices, "openhaptics")) add(findings, examine_openhaptics(devices));
  const bool force_dimension = has_type(devices, "forcedimension");
  if (!config || force_dimension) {
    findings.push_back(judge_library("libdhd.so", failure_of(dhd::library), force_dimension));
    add(findings, judge_usb(dhd::find_usb_devices(), force_dimension));
  }
  return findings;
}

// All at once, as the bridge has them.
Findings open_devices(const std::vector<DeviceConfig>& configs) {
  Findings findings;
  std::vector<std::unique_ptr<HapticDevice>> opened;
  for (std::size_t i = 0; i < configs.size(); ++i) {
    const std::string subject = "device " + std::to_string(i) + " (" + configs[i].type + ")";
    try {
      auto device = make_device(configs[i]);
      device->open();
      opened.push_back(std::move(device));
      findings.push_back({Grade::kOk, subject, "opens", ""});
    } catch (const Error& error) {
      findings.push_back({Grade::kProblem, subject, error.what(), ""});
    }
  }
  for (auto& device : opened) device->close();
  return findings;
}

// How long the services of devices take to answer; those that do not open are told of above.
Findings examine_services(const std::vector<DeviceConfig>& configs) {
  constexpr std::chrono::milliseconds kMeasured(500);
  Findings findings;
  for (std::size_t i = 0; i < configs.size(); ++i) {
    if (configs[i].type != "haply") continue;
    HaplyDevice device(inverse_settings(configs[i]));
    if (!failure_of([&] { device.open(); }).empty()) continue;
    std::this_thread::sleep_for(kMeasured);
    device.close();
    const haply::InverseReport& report = device.report();
    findings.push_back(judge_service("service of device " + std::to_string(i), report.answers,
                                     report.round_trip.percentile(0.99)));
  }
  return findings;
}

Finding examine_server(const BridgeConfig& config) {
  const ServerAddress& server = *config.server;
  const std::string address = address_text(server.host, server.port);
  try {
    return judge_server(ask_server(client_settings(config), config.devices.size()), address);
  } catch (const Error& error) {
    return judge_server({.words = error.what()}, address);
  }
}

}  // namespace

Findings examine(const std::optional<BridgeConfig>& config) {
  const RealTimeScheduling scheduling = config ? config->realtime : RealTimeScheduling::kPrefer;
  Findings findings = examine_drivers(config);
  if (config) {
    add(findings, open_devices(config->devices));
    add(findings, examine_services(config->devices));
  }
  findings.push_back(judge_real_time(try_real_time(), scheduling));
  findings.push_back(judge_locked_memory(try_locked_memory(), scheduling));
  const ClockFacts clock = look_at_clock();
  findings.push_back(judge_clock_source(clock));
  findings.push_back(judge_wakeup(clock));
  if (config && config->server) findings.push_back(examine_server(*config));
  return findings;
}

}  // namespace irdm::doctor
