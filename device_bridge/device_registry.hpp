#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device_bridge/bridge_config.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm {

/// Says what devices complain of, once each time that it changes. Main thread.
class DeviceWatch {
 public:
  explicit DeviceWatch(const std::vector<std::unique_ptr<HapticDevice>>& devices)
      : devices_(devices), said_(devices.size()) {}

  /// Logs what is new.
  void look();
  /// What devices complain of now, in one line; empty: nothing.
  std::string troubles() const;

 private:
  const std::vector<std::unique_ptr<HapticDevice>>& devices_;
  std::vector<std::string> said_;
};

/// The device that a configuration asks for. Throws Error when there is no such type, or this build
/// has no support for it. A new device is a new file, one line in the source of this function and
/// one in device_types().
std::unique_ptr<HapticDevice> make_device(const DeviceConfig& config);

}  // namespace irdm
