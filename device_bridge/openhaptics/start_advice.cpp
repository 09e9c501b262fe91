#include "device_bridge/openhaptics/start_advice.hpp"

#include <algorithm>

namespace irdm::hd {

const char* const kPermissionRemedy =
    "install the vendor's udev rules (91-3dsystems-*.rules) or join the group that owns it "
    "(dialout), then plug the device in again";
const char* const kCommaRemedy =
    "write its numbers with decimal points, or set the device up again under LC_ALL=C";

const DeviceSetup* find_setup(const TouchSystem& system, const std::string& name) {
  const auto found = std::find_if(system.setups.begin(), system.setups.end(),
                                  [&](const DeviceSetup& setup) { return setup.name == name; });
  return found == system.setups.end() ? nullptr : &*found;
}

std::string setup_names(const TouchSystem& system) {
  std::string names;
  for (const DeviceSetup& setup : system.setups) names += (names.empty() ? "" : ", ") + setup.name;
  return names;
}

Advice start_advice(const std::string& name, const ErrorInfo& error, const TouchSystem& system) {
  const ErrorText& text = describe(error.code);
  const std::string refusal = "the driver does not start it: " + to_text(error);
  if (error.code == kAlreadyInitiated) return {refusal, text.remedy};
  const DeviceSetup* const setup = find_setup(system, name);
  if (!name.empty() && setup == nullptr && !system.setups.empty()) {
    return {"no device of this name is set up, only: " + setup_names(system),
            "correct its name, or set it up with the vendor's Touch_Setup"};
  }
  if (system.ports.empty()) {
    return {refusal + "; and no device of 3D Systems is on USB",
            "check power and cable; a device on the network or another bus has to be set up with "
            "the vendor's Touch_Setup"};
  }
  const auto closed = std::find_if(system.ports.begin(), system.ports.end(),
                                   [](const DevicePort& port) { return !port.permitted; });
  if (closed != system.ports.end()) {
    return {"no permission for " + closed->path, kPermissionRemedy};
  }
  if (setup != nullptr && setup->decimal_comma) {
    return {setup->file.string() + " has decimal commas", kCommaRemedy};
  }
  return {refusal, text.remedy};
}

}  // namespace irdm::hd
