#include <algorithm>
#include <optional>

#include "device_bridge/forcedimension/forcedimension_device.hpp"
#include "device_bridge/servo_loop.hpp"
#include "tests/bridge/link_faults.hpp"
#include "tests/forcedimension/fake_api.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kMostTicks = 50;  // of 1 ms
const Vector3 kForce(0, 8, 0);
const Vector3 kTorque(0, 0, 0.1);

/// The servo loop of a device with an active wrist, on a virtual clock of 1 ms a tick, in contact.
class SteppedLoop {
 public:
  SteppedLoop() {
    fakedhd_reset();
    fakedhd_model(0, "sigma.7", 104);
    fakedhd_activate_wrist(0);
    device.open();
    loop.emplace(device,
                 FilterLimits{.max_force = 12.0, .continuous_force = 6.0, .max_torque = 0.2});
    tick(1000);
    REQUIRE(force() == Approx(8.1));
  }
  /// So many ticks in which the server asks for the same.
  void tick(int count) {
    for (int k = 0; k < count; ++k) {
      input.force.sample_time_ns = now_ns + kMs;
      tick_as_is();
    }
  }
  void tick_as_is() {
    now_ns += kMs;
    loop->read(0.0);
    loop->apply(now_ns, input);
  }
  /// That acts: force [N] and torque [N m], as one number.
  double force() const {
    Vector3 force;
    Vector3 torque;
    fakedhd_force(0, force.data());
    fakedhd_torque(0, torque.data());
    return force.norm() + torque.norm();
  }

  ForceDimensionDevice device{"0", fake_api()};
  std::optional<ServoLoop> loop;
  ServoInput input{
      .linked = true, .any_force = true, .force = {.force = kForce, .torque = kTorque}};
  std::int64_t now_ns = 0;
};

}  // namespace

TEST_CASE("Force Dimension: whatever goes wrong with the link, force and torque end within 50 ms") {
  for (const LinkFault& fault : kLinkFaults) {
    CAPTURE(fault.name);
    SteppedLoop stepped;
    const ServoInput good = stepped.input;
    CHECK(ticks_to_zero(stepped, fault) <= kMostTicks);
    CHECK(stepped.device.state().ready);
    CHECK(fakedhd_force_is_on(0) == 1);
    // The device goes on: a link that is good again brings the force back.
    stepped.input = good;
    stepped.tick(700);
    CHECK(stepped.force() == Approx(8.1));
  }
}

TEST_CASE("Force Dimension: whatever goes wrong with the device, it is sent none within 50 ms") {
  struct Fault {
    const char* name;
    void (*cause)();
    bool ready;
  };
  const Fault fault = GENERATE(Fault{"force button", [] { fakedhd_force_off(0, 1); }, false},
                               Fault{"velocity limit", [] { fakedhd_force_off(0, 2); }, false},
                               Fault{"watchdog", [] { fakedhd_force_off(0, 3); }, false},
                               Fault{"not initialised", [] { fakedhd_initialised(0, 0); }, false},
                               Fault{"readings fail", [] { fakedhd_unplug(0, 1); }, true});
  CAPTURE(fault.name);
  SteppedLoop stepped;
  fault.cause();
  stepped.tick(kMostTicks);
  CHECK(stepped.loop->shown().isZero(0.0));
  CHECK(stepped.loop->shown_torque().isZero(0.0));
  CHECK(stepped.device.state().ready == fault.ready);
}

TEST_CASE("Force Dimension: force and torque rise from zero when the device has turned them on") {
  const int cause = GENERATE(1, 2, 3);
  CAPTURE(cause);
  SteppedLoop stepped;
  fakedhd_force_off(0, cause);
  while (stepped.device.state().ready) {
    stepped.tick(1);
    // The object gets no more than the device shows, from the status on.
    CHECK(stepped.loop->shown().isZero(0.0) == stepped.device.state().off);
  }
  CHECK(stepped.loop->shown_torque().isZero(0.0));
  stepped.tick(1);
  if (cause == 1)
    fakedhd_force_off(0, 0);  // pressed again, before the filter has been through a fade
  double rise = 0.0;
  for (int tick = 0; tick < 1500; ++tick) {
    const double before = stepped.force();
    stepped.tick(1);
    rise = std::max(rise, stepped.force() - before);
  }
  CHECK(rise < 1.001 * 8.1 / 500);
  CHECK(stepped.force() == Approx(8.1));
}
