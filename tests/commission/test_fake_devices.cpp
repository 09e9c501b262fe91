#include <memory>

#include "device_bridge/forcedimension/forcedimension_device.hpp"
#include "tests/commission/held_device.hpp"
#include "tests/commission/played_plan.hpp"
#include "tests/commission/step_rig.hpp"
#include "tests/forcedimension/fake_api.hpp"
#include "tests/openhaptics/fake_session.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::StartsWith;
using namespace irdm;
using namespace irdm::commission;
using namespace irdm::test;

namespace {

/// Of the fake libHD.so, whose ticks are made by hand.
Report commission_touch(const Matrix3& reading_axes = Matrix3::Identity(),
                        const Matrix3& force_axes = Matrix3::Identity()) {
  const FakeSession session;
  fakehd_drive_by_hand();
  const auto scheduler = std::make_shared<OpenHapticsScheduler>(FakeSession::api());
  OpenHapticsDevice device("", scheduler);
  device.open();
  HeldDevice held(device);
  scheduler->start(1000.0, [&] {
    held.tick();
    return true;
  });
  const auto tick = [&] {
    held.hand.advance(1e-3, force_axes * force_of(""));
    const Vector3 mm = 1e3 * (reading_axes * held.sensor.measure(held.hand.tip()));
    fakehd_place("", mm.x(), mm.y(), mm.z());
    fakehd_press("", static_cast<int>(held.hand.buttons()));
    if (held.hand.unplugs()) fakehd_unplug("");
    fakehd_tick(1);
  };
  Report report = play_plan(
      {}, held.runner(), [&](const Order& order) { held.hand.obey(order); }, tick);
  report.type = "openhaptics";
  report.device = device.identity();
  scheduler->stop();
  device.close();
  return report;
}

/// Of the fake libdhd.so, in the driver's axes.
Report commission_omega() {
  fakedhd_reset();
  ForceDimensionDevice device("", fake_api());
  device.open();
  HeldDevice held(device);
  const auto tick = [&] {
    Vector3 force;
    fakedhd_force(0, force.data());
    held.hand.advance(1e-3, Vector3(force.y(), force.z(), force.x()));
    const Vector3 tip = held.sensor.measure(held.hand.tip());
    fakedhd_place(0, tip.z(), tip.x(), tip.y());
    fakedhd_press(0, held.hand.buttons());
    if (held.hand.unplugs()) fakedhd_unplug(0, 1);
    held.tick();
  };
  Report report = play_plan(
      {}, held.runner(), [&](const Order& order) { held.hand.obey(order); }, tick);
  report.type = "forcedimension";
  report.device = device.identity();
  return report;
}

}  // namespace

TEST_CASE("commission: the fake of OpenHaptics passes all steps, and its report is the example") {
  const Report report = commission_touch();
  INFO(to_text(report));
  CHECK(report.signed_off());
  CHECK(report.device == "Touch, serial number fake-1");
  check_example(report, "commission-openhaptics.toml");
}

TEST_CASE("commission: the fake of Force Dimension passes all steps, its report is the example") {
  const Report report = commission_omega();
  INFO(to_text(report));
  CHECK(report.signed_off());
  CHECK(report.device == "omega.6, serial number 10234");
  check_example(report, "commission-forcedimension.toml");
}

TEST_CASE("commission: a fake whose axes are swapped, or whose force is reversed, does not pass") {
  CHECK_THAT(last_step(commission_touch(swapped(1, 2))),
             StartsWith("axis up: up is +z, not +y: axes are swapped"));
  CHECK_THAT(last_step(commission_touch(Matrix3::Identity(), reversed(0))),
             StartsWith("force right: a force along +x moved the handle along -x"));
}
