#pragma once

#include <string>
#include <vector>

#include "common/program/stop_signal.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/commission/person.hpp"
#include "device_bridge/commission/report.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm::commission {

/// Leads a person through all steps with a device: opens it, runs its servo loop with the safety
/// filter, and closes it. The first step that does not pass is the last. Throws Error when the
/// servo loop cannot run.
/// @param config with this device only
/// @param device as made, not open
/// @param pushing command of another process, which calls push_until_stopped()
Report commission(const BridgeConfig& config, HapticDevice& device, Person& person,
                  const std::vector<std::string>& pushing);

/// Pushes the handle up with StopStep::kForce until a signal comes or the device is lost, 60 s at
/// most. Throws like commission().
void push_until_stopped(const BridgeConfig& config, HapticDevice& device, StopSignal& signal);

}  // namespace irdm::commission
