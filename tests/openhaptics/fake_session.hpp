#pragma once

#include <memory>
#include <string>

#include "device_bridge/openhaptics/hd_library.hpp"
#include "device_bridge/openhaptics/openhaptics_device.hpp"
#include "device_bridge/servo_loop.hpp"
#include "tests/bridge/milliseconds.hpp"
#include "tests/fake_libhd/control.hpp"
#include "tests/support/catch.hpp"

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

/// Of the last frame [N].
inline Vector3 force_of(const char* name) {
  Vector3 force;
  fakehd_force(name, force.data());
  return force;
}

inline Vector3 torque_of(const char* name) {  ///< [N m]
  Vector3 torque;
  fakehd_torque(name, torque.data());
  return 1e-3 * torque;
}

/// A device in ticks that the test makes one by one, each with a frame.
class SteppedDevice {
 public:
  explicit SteppedDevice(const std::string& name = "", double rate = 1000.0)
      : scheduler(std::make_shared<OpenHapticsScheduler>(FakeSession::api())),
        device(name, scheduler) {
    fakehd_drive_by_hand();
    device.open();
    scheduler->start(rate, [this] {
      pose = device.read(0.0);
      device.write({wanted, wanted_torque});
      return true;
    });
  }
  ~SteppedDevice() {
    scheduler->stop();
    device.close();
  }
  const StylusPose& tick(int count = 1) {
    fakehd_tick(count);
    return pose;
  }

  std::shared_ptr<OpenHapticsScheduler> scheduler;
  OpenHapticsDevice device;
  StylusPose pose;
  Vector3 wanted = Vector3::Zero();
  Vector3 wanted_torque = Vector3::Zero();
};

/// The servo loop of the default device, on a virtual clock of 1 ms a tick.
class SteppedLoop {
 public:
  explicit SteppedLoop(const FilterLimits& limits = {})
      : scheduler_(std::make_shared<OpenHapticsScheduler>(FakeSession::api())),
        device("", scheduler_),
        loop(device, limits) {
    fakehd_drive_by_hand();
    device.open();
    scheduler_->start(1000.0, [this] {
      loop.read(0.0);
      loop.apply(now_ns, input);
      return true;
    });
  }
  ~SteppedLoop() {
    scheduler_->stop();
    device.close();
  }
  /// So many ticks in which the server asks for this.
  void tick(int count, const Vector3& force_W) {
    for (int k = 0; k < count; ++k) {
      input.force.force = force_W;
      input.force.sample_time_ns = now_ns + kMs;
      tick_as_is();
    }
  }
  /// Arms; afterwards the force is shown in full.
  void engage(const Vector3& force_W) {
    tick(100, Vector3::Zero());
    tick(100, force_W);
    REQUIRE(force_of("").isApprox(force_W));
  }
  /// One with `input` as it is.
  void tick_as_is() {
    now_ns += kMs;
    fakehd_tick(1);
  }
  /// That the motors show [N].
  double force() const { return force_of("").norm(); }

 private:
  std::shared_ptr<OpenHapticsScheduler> scheduler_;

 public:
  OpenHapticsDevice device;
  ServoLoop loop;
  ServoInput input{.linked = true, .any_force = true};
  std::int64_t now_ns = 0;
};

}  // namespace irdm::test
