#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "common/error.hpp"
#include "device_bridge/forcedimension/forcedimension_device.hpp"
#include "device_bridge/servo_thread.hpp"
#include "tests/fake_libdhd/fake_dhd.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"

using Catch::Matchers::Contains;
using namespace irdm;
using namespace irdm::test;

namespace {

const dhd::Api& api() {
  static const dhd::Api kApi = dhd::load_library({IRDM_FAKE_LIBDHD});
  return kApi;
}

Vector3 force_of(int index) {
  Vector3 force;
  fakedhd_force(index, force.data());
  return force;
}

Vector3 torque_of(int index) {
  Vector3 torque;
  fakedhd_torque(index, torque.data());
  return torque;
}

}  // namespace

TEST_CASE("libdhd.so is looked for by its usual names, or by the one that is given alone") {
  ::unsetenv("FORCEDIMENSION_LIB");
  CHECK(dhd::library_names().front() == "libdhd.so.3");
  ::setenv("FORCEDIMENSION_LIB", "/opt/libdrd.so", 1);
  CHECK(dhd::library_names() == std::vector<std::string>{"/opt/libdrd.so"});
  ::unsetenv("FORCEDIMENSION_LIB");
  CHECK_THROWS_WITH(dhd::load_library({"/nowhere/libdhd.so"}),
                    Contains("/nowhere/libdhd.so") && Contains("install the 64-bit"));
}

TEST_CASE("a device of Force Dimension is opened by its number or as the first, and closed") {
  fakedhd_reset();
  ForceDimensionDevice second("1", api());
  second.open();
  CHECK(fakedhd_is_open(1) == 1);
  CHECK(fakedhd_force_is_on(1) == 1);
  CHECK(fakedhd_is_open(0) == 0);
  {
    ForceDimensionDevice first("", api());
    first.open();
    CHECK(fakedhd_is_open(0) == 1);
    ForceDimensionDevice again("0", api());
    CHECK_THROWS_WITH(again.open(), Contains("cannot be opened: no device found"));
  }
  CHECK(fakedhd_is_open(0) == 0);
  CHECK(fakedhd_force_is_on(0) == 0);
  ForceDimensionDevice nameless("Left", api());
  CHECK_THROWS_WITH(nameless.open(), Contains("has no number"));
}

TEST_CASE("positions, orientations and forces are taken from the driver's axes to ours and back") {
  fakedhd_reset();
  ForceDimensionDevice device("", api());
  device.open();
  fakedhd_place(0, 0.03, 0.01, 0.02);  // towards the person, right, up
  fakedhd_press(0, 2);
  // A quarter turn about the driver's z, which is up: our y.
  const std::array<double, 9> turned{0, -1, 0, 1, 0, 0, 0, 0, 1};
  fakedhd_turn(0, turned.data());
  const StylusPose pose = device.read(0.0);
  CHECK(pose.tip.isApprox(Vector3(0.01, 0.02, 0.03)));
  CHECK(pose.buttons == 2);
  CHECK((pose.orientation * Vector3::UnitY()).isApprox(Vector3::UnitY()));
  CHECK((pose.orientation * Vector3::UnitZ()).isApprox(Vector3::UnitX()));
  device.write({Vector3(1, 2, 3)});
  CHECK(force_of(0).isApprox(Vector3(3, 1, 2)));
  device.write({Vector3(0, std::nan(""), 0)});
  CHECK(force_of(0).isZero(0.0));
}

TEST_CASE("a device with an active wrist gets torques, in the driver's axes, and others none") {
  fakedhd_reset();
  fakedhd_activate_wrist(1);
  ForceDimensionDevice passive("0", api());
  passive.open();
  CHECK(passive.rating().peak_torque == 0.0);
  passive.write({Vector3(1, 2, 3), Vector3(0.1, 0.2, 0.3)});
  CHECK(force_of(0).isApprox(Vector3(3, 1, 2)));
  CHECK(torque_of(0).isZero(0.0));
  ForceDimensionDevice active("1", api());
  active.open();
  CHECK(active.rating().peak_torque > 0.0);
  active.write({Vector3(1, 2, 3), Vector3(0.1, 0.2, 0.3)});
  CHECK(force_of(1).isApprox(Vector3(3, 1, 2)));
  CHECK(torque_of(1).isApprox(Vector3(0.3, 0.1, 0.2)));
  active.write({Vector3(1, 2, 3), Vector3(0.1, std::nan(""), 0.3)});
  CHECK(force_of(1).isApprox(Vector3(3, 1, 2)));
  CHECK(torque_of(1).isZero(0.0));
  active.write({Vector3(1, 2, 3), Vector3(0.1, 0.2, 0.3)});
  active.close();
  CHECK(force_of(1).isZero(0.0));
  CHECK(torque_of(1).isZero(0.0));
}

TEST_CASE("readings that fail are of no use, and after fifty the device is lost") {
  fakedhd_reset();
  ForceDimensionDevice device("", api());
  device.open();
  fakedhd_unplug(0, 1);
  for (int tick = 0; tick < 49; ++tick) CHECK(device.read(0.0).tip.hasNaN());
  fakedhd_unplug(0, 0);
  CHECK_FALSE(device.read(0.0).tip.hasNaN());
  CHECK_FALSE(device.state().lost);
  fakedhd_unplug(0, 1);
  for (int tick = 0; tick < 50; ++tick) device.read(0.0);
  CHECK(device.state().lost);
  CHECK(device.state().failed);
  CHECK_THAT(device.trouble(), Contains("no readings any more"));
}

TEST_CASE("a tick with a device of Force Dimension allocates nothing") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  fakedhd_reset();
  ForceDimensionDevice device("", api());
  device.open();
  const AllocationGuard guard;
  for (int tick = 0; tick < 100; ++tick) {
    device.read(0.0);
    device.write({Vector3(0, 1, 0)});
  }
  CHECK(guard.count() == 0);
}

TEST_CASE("a device of Force Dimension that is unplugged ends the servo thread") {
  fakedhd_reset();
  ForceDimensionDevice device("", api());
  device.open();
  std::vector<ServoLoop> loops;
  loops.emplace_back(device, FilterLimits{});
  ServoLink link(1);
  EventFd done;
  ServoThread servo(link, loops, {.duration = std::numeric_limits<double>::infinity()}, done);
  servo.start();
  link.state.put({.linked = true, .sessions = 1, .dt = 0.002});
  REQUIRE(eventually([&] {
    if (link.styluses[0].sample.receive()) {
      link.styluses[0].input.put(
          {.linked = true,
           .any_force = true,
           .force = {.sample_time_ns = link.styluses[0].sample.front().time_ns,
                     .force = Vector3(0, 2, 0)}});
    }
    return force_of(0).norm() > 1.9;
  }));
  fakedhd_unplug(0, 1);
  REQUIRE(done.wait(kDeadlineMs));
  servo.stop();
  CHECK(servo.report().end == ServoEnd::kDeviceLost);
  CHECK(loops[0].counts().faults > 0);
}
