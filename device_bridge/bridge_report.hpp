#pragma once

#include <cstdint>
#include <string>

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
  FilterCounts filter = {};  ///< of all styluses
};

/// A few lines for a person, each `name: values`.
std::string to_text(const BridgeReport& report);

}  // namespace irdm
