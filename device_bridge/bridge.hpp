#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "common/program/stop_signal.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/network_client.hpp"
#include "device_bridge/servo_thread.hpp"

namespace irdm {

/// What a bridge tells at its end.
struct BridgeReport {
  ServoReport servo;
  ClientReport client;
  std::string scheduling;  ///< of the servo thread, and whether memory is locked
  int styluses = 0;
  double peak_force = 0.0;   ///< shown on any stylus [N]
  double impulse = 0.0;      ///< of the force's magnitude, on all styluses together [N s]
  double peak_torque = 0.0;  ///< shown on any stylus [N m]
  FilterCounts filter = {};  ///< of all styluses
  /// A device or its driver ended the run; then client.failure says how.
  bool device_fault = false;
  /// Steps in contact whose force faded as the server's contact models did not reach them, of all
  /// styluses.
  std::uint64_t withheld = 0;
};

/// A few lines for a person, each `name: values`.
std::string to_text(const BridgeReport& report);

/// What the safety filter bounds: as configured, or the device's own limits where they are lower.
/// @param device open
FilterLimits filter_limits(const HapticDevice& device, const BridgeConfig& config);

/// How a bridge of this configuration connects. Throws Error about its key file.
/// @param config with a server
ClientSettings client_settings(const BridgeConfig& config);

/// Runs a bridge until its devices have no more to play, `duration` of session time is over, a
/// signal comes, or the client gives up, which report.client.failure then tells. Throws Error when
/// it cannot start.
/// @param config with a server
/// @param duration [s], > 0
BridgeReport run_bridge(const BridgeConfig& config, StopSignal& stop_signal,
                        double duration = std::numeric_limits<double>::infinity());

}  // namespace irdm
