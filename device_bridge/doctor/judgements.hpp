#pragma once

#include <string>

#include "device_bridge/doctor/facts.hpp"
#include "device_bridge/doctor/finding.hpp"
#include "device_bridge/openhaptics/touch_system.hpp"

/// What facts mean for a person. Pure.
namespace irdm::doctor {

/// @param library its name
/// @param failure of loading it; empty: it loads
/// @param wanted whether a device of it is configured; where none is, what is missing is no problem
Finding judge_library(const std::string& library, const std::string& failure, bool wanted);

/// One for each port, or one for none.
Findings judge_ports(const hd::TouchSystem& system, bool wanted);

/// The vendor's setup of a configured device. @param name empty: the driver's default device
Finding judge_setup(const hd::TouchSystem& system, const std::string& name);

Finding judge_real_time(const Permission& permission, RealTimeScheduling wanted);
Finding judge_locked_memory(const Permission& permission, RealTimeScheduling wanted);
Finding judge_clock_source(const ClockFacts& clock);
Finding judge_wakeup(const ClockFacts& clock);

/// @param address as a person writes it
Finding judge_server(const ServerFacts& server, const std::string& address);

}  // namespace irdm::doctor
