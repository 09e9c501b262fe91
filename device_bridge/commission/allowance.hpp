#pragma once

#include <limits>
#include <string>

#include "device_bridge/bridge_config.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm::commission {

inline constexpr double kUncommissionedForce = 1.0;  ///< [N]

/// The largest force and torque of a device, by its commissioning.
struct Allowance {
  double force = std::numeric_limits<double>::infinity();   ///< [N]
  double torque = std::numeric_limits<double>::infinity();  ///< [N m]
  std::string words = {};  ///< why it is less, and what to do; empty: it is not
};

/// Without a report a device that is no simulation may show 1 N; with one, as much as was shown in
/// it. A torque is not tried in it, and may be that of 1 N at kLever in either case. Throws Error
/// when the report is of another device.
/// @param device open
/// @param max_force as configured [N]
Allowance allowance(const DeviceConfig& config, const HapticDevice& device, double max_force);

}  // namespace irdm::commission
