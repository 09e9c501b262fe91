#include "device_bridge/device_registry.hpp"

#include <spdlog/spdlog.h>
#include <array>
#include <utility>

#include "common/error.hpp"
#include "device_bridge/forcedimension/forcedimension_device.hpp"
#include "device_bridge/haply/haply_device.hpp"
#include "device_bridge/openhaptics/openhaptics_device.hpp"
#include "device_bridge/virtual_stylus.hpp"

namespace irdm {

void DeviceWatch::look() {
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    const std::string trouble = devices_[i]->trouble();
    if (trouble != said_[i] && !trouble.empty()) spdlog::error("{}", trouble);
    said_[i] = trouble;
  }
}

std::string DeviceWatch::troubles() const {
  std::string all;
  for (const auto& device : devices_) {
    const std::string trouble = device->trouble();
    if (!trouble.empty()) all += (all.empty() ? "" : "; ") + trouble;
  }
  return all;
}

namespace {

struct Entry {
  const char* type;
  std::unique_ptr<HapticDevice> (*make)(const DeviceConfig&);
};

constexpr std::array kEntries{
    Entry{"virtual", make_virtual_stylus},
    Entry{"openhaptics", make_openhaptics_device},
    Entry{"forcedimension", make_forcedimension_device},
    Entry{"haply", make_haply_device},
};

}  // namespace

std::unique_ptr<HapticDevice> make_device(const DeviceConfig& config) {
  for (const Entry& entry : kEntries) {
    if (config.type == entry.type) return entry.make(config);
  }
  throw Error("device " + in_quotes(config.type), "is not a known type",
              "use virtual, openhaptics, forcedimension or haply");
}

}  // namespace irdm
