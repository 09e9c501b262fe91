#pragma once

#include <memory>
#include <vector>

#include "device_bridge/commission/step.hpp"
#include "device_bridge/workspace.hpp"

namespace irdm::commission {

/// What the steps depend on.
struct PlanSettings {
  double rate = 1000.0;    ///< of the servo loop [Hz]
  double max_force = 3.3;  ///< configured, or the device's if that is lower [N]
  ButtonMap buttons = {};
  bool simulated = false;  ///< the device: it has no cable
};

/// All steps that ticks are needed for, in their order: first what needs no force, then small
/// forces, last what may lose the device.
std::vector<std::unique_ptr<Step>> make_plan(const PlanSettings& settings);

}  // namespace irdm::commission
