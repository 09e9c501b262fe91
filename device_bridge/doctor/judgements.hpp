#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device_bridge/doctor/facts.hpp"
#include "device_bridge/forcedimension/dhd_usb.hpp"
#include "device_bridge/openhaptics/touch_system.hpp"

namespace irdm::doctor {

enum class Grade {
  kOk,
  kWarning,  ///< works, but not well
  kProblem,  ///< the bridge will not do what is asked of it
};

/// One line of what the doctor says.
struct Finding {
  Grade grade = Grade::kOk;
  std::string subject;  ///< what was looked at
  std::string what;     ///< how it is
  std::string remedy;   ///< what to do; empty where it is ok
};

using Findings = std::vector<Finding>;

/// A line each: `grade subject: what; remedy`.
std::string to_text(const Findings& findings);
int count_problems(const Findings& findings);

// What facts mean for a person. Pure.

/// @param library its name
/// @param failure of loading it; empty: it loads
/// @param wanted whether a device of it is configured; where none is, what is missing is no problem
Finding judge_library(const std::string& library, const std::string& failure, bool wanted);

/// One for each port, or one for none.
Findings judge_ports(const hd::TouchSystem& system, bool wanted);

/// The same of devices of Force Dimension.
Findings judge_usb(const std::vector<dhd::UsbDevice>& devices, bool wanted);

/// The vendor's setup of a configured device. @param name empty: the driver's default device
Finding judge_setup(const hd::TouchSystem& system, const std::string& name);

Finding judge_real_time(const Permission& permission, RealTimeScheduling wanted);
Finding judge_locked_memory(const Permission& permission, RealTimeScheduling wanted);
Finding judge_clock_source(const ClockFacts& clock);
Finding judge_wakeup(const ClockFacts& clock);

/// Of the service of a device that is reached by a network connection.
/// @param answers that were counted  @param round_trip_ns that 99 % of them do not exceed
Finding judge_service(const std::string& subject, std::uint64_t answers,
                      std::int64_t round_trip_ns);

/// @param address as a person writes it
Finding judge_server(const ServerFacts& server, const std::string& address);

}  // namespace irdm::doctor
