#pragma once

#include <memory>
#include <string>
#include <vector>

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

}  // namespace irdm
