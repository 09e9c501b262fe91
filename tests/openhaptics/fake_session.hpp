#pragma once

#include <catch2/catch.hpp>
#include <memory>
#include <string>

#include "device_bridge/openhaptics/hd_library.hpp"
#include "device_bridge/openhaptics/openhaptics_device.hpp"
#include "tests/fake_libhd/control.hpp"

namespace irdm::test {

/// The fake driver as if just loaded, and at the end the check that nobody misused it.
class FakeSession {
 public:
  FakeSession() { fakehd_reset(); }
  FakeSession(const FakeSession&) = delete;
  FakeSession& operator=(const FakeSession&) = delete;
  ~FakeSession() {
    INFO("misuse: " << fakehd_first_misuse());
    CHECK(fakehd_misuses() == 0);
  }

  /// The functions of the fake, looked up as in the real library.
  static const hd::Api& api() {
    static const hd::Api kApi = hd::load_library({IRDM_FAKE_LIBHD});
    return kApi;
  }
};

inline Vector3 force_of(const char* name) {
  Vector3 force;
  fakehd_force(name, force.data());
  return force;
}

}  // namespace irdm::test
