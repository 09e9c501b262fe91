#include "device_bridge/device_watch.hpp"

#include <spdlog/spdlog.h>

#include <utility>

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

}  // namespace irdm
