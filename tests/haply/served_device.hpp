#pragma once

#include "device_bridge/haply/haply_device.hpp"
#include "tests/bridge/served_device.hpp"
#include "tests/haply/fake_service.hpp"

namespace irdm::test {

/// A Haply device in a servo thread, and a server that always asks for the same force.
struct ServedHaply : ServedDevice<HaplyDevice> {
  explicit ServedHaply(const FakeService& service) : ServedDevice(service.settings()) {
    begin_session();
  }
  /// Whether the service was told the whole force last.
  bool felt(const FakeService& service) const { return service.told().force.z() > 0.9 * kDemand; }
};

}  // namespace irdm::test
