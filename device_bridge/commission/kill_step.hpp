#pragma once

#include <string>
#include <vector>

#include "device_bridge/commission/person.hpp"
#include "device_bridge/commission/report.hpp"

namespace irdm::commission {

inline constexpr const char* kKillStep = "stop of a killed bridge";

/// Kills a process that pushes the handle up, and takes the time until the person says that the
/// force is gone. Main thread; the device is not open in this process.
/// @param pushing command of that process (push_until_stopped())
StepRecord run_kill_step(const std::vector<std::string>& pushing, Person& person,
                         Measured& measured);

}  // namespace irdm::commission
