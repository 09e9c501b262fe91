#pragma once

#include <string>

#include "device_bridge/openhaptics/hd_error.hpp"
#include "device_bridge/openhaptics/touch_system.hpp"

namespace irdm::hd {

/// What is wrong, and what to do about it.
struct Advice {
  std::string what;
  std::string remedy;
};

/// Why the driver does not start a device: its error says little, so what the system knows is
/// looked at first. Pure.
/// @param name as configured; empty: the driver's default device
Advice start_advice(const std::string& name, const ErrorInfo& error, const TouchSystem& system);

/// The setup of a device of this name; nullptr: none. An empty name: none either. Pure.
const DeviceSetup* find_setup(const TouchSystem& system, const std::string& name);

/// "A, B" of all setups. Pure.
std::string setup_names(const TouchSystem& system);

extern const char* const kPermissionRemedy;
extern const char* const kCommaRemedy;

}  // namespace irdm::hd
