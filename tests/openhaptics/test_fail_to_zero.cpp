#include <algorithm>
#include <array>

#include "tests/bridge/link_faults.hpp"
#include "tests/openhaptics/fake_session.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kMostTicks = 50;  // of 1 ms
const Vector3 kFeltForce(0, 3, 0);

}  // namespace

TEST_CASE("OpenHaptics: whatever goes wrong with the link, the motors are at zero within 50 ms") {
  for (const LinkFault& fault : kLinkFaults) {
    CAPTURE(fault.name);
    const FakeSession session;
    SteppedLoop stepped;
    stepped.engage(kFeltForce);
    CHECK(ticks_to_zero(stepped, fault) <= kMostTicks);
    CHECK(stepped.device.state().ready);
    CHECK_FALSE(stepped.device.state().failed);
    // The device goes on: a link that is good again brings the force back.
    stepped.input = {.linked = true, .any_force = true};
    stepped.tick(700, kFeltForce);
    CHECK(force_of("").isApprox(kFeltForce));
  }
}

TEST_CASE("OpenHaptics: whatever goes wrong with the device, the motors are at zero within 50 ms") {
  struct Fault {
    const char* name;
    void (*cause)();
    bool ready, failed, lost;  // afterwards
  };
  const Fault fault =
      GENERATE(Fault{"unplugged", [] { fakehd_unplug(""); }, true, true, true},
               Fault{"too fast", [] { fakehd_raise_at_end("", 0x0203); }, false, false, false},
               Fault{"timer", [] { fakehd_raise_at_end("", 0x0304); }, true, true, false},
               Fault{"fault", [] { fakehd_raise_at_begin("", 0x0300); }, true, true, true},
               Fault{"no rotation",
                     [] {
                       const std::array<double, 16> none{};
                       fakehd_transform("", none.data());
                     },
                     true, false, false});
  CAPTURE(fault.name);
  const FakeSession session;
  SteppedLoop stepped;
  stepped.engage(kFeltForce);
  fault.cause();
  int ticks = 0;
  while (stepped.force() > 0.0 && ticks <= kMostTicks) {
    stepped.tick(1, kFeltForce);
    ++ticks;
  }
  CHECK(ticks <= kMostTicks);
  CHECK(stepped.device.state().ready == fault.ready);
  CHECK(stepped.device.state().failed == fault.failed);
  CHECK(stepped.device.state().lost == fault.lost);
  stepped.tick(kMostTicks, kFeltForce);
  CHECK(stepped.force() == 0.0);
}

TEST_CASE(
    "OpenHaptics: a force that the driver has turned off rises from zero when it is on again") {
  const FakeSession session;
  SteppedLoop stepped;
  stepped.engage(kFeltForce);
  fakehd_force_off("", 1);
  stepped.tick(1, kFeltForce);
  CHECK(stepped.loop.shown().isZero(0.0));
  CHECK(stepped.device.state().off);
  CHECK_FALSE(stepped.device.state().ready);
  CHECK_THAT(stepped.device.trouble(),
             Catch::Matchers::ContainsSubstring("its driver has turned it off"));
  fakehd_force_off("", 0);
  double rise = 0.0;
  for (int tick = 0; tick < 700; ++tick) {
    const double before = stepped.force();
    stepped.tick(1, kFeltForce);
    rise = std::max(rise, stepped.force() - before);
  }
  CHECK(rise < 1.001 * kFeltForce.norm() / 500);
  CHECK(force_of("").isApprox(kFeltForce));
  CHECK(stepped.loop.counts().faults == 0);
}

TEST_CASE("OpenHaptics: a calibration that is lost takes the force with the look that finds it") {
  const FakeSession session;
  SteppedLoop stepped;
  stepped.engage(kFeltForce);
  fakehd_calibration("", 0x5002, 4);
  const unsigned long looks = fakehd_calibration_checks("");
  while (fakehd_calibration_checks("") == looks) stepped.tick(1, kFeltForce);
  CHECK(stepped.force() == 0.0);
  CHECK(stepped.loop.shown().isZero(0.0));  // so is what the object gets
}
