// What the safety filter makes of a device that shows nothing any more, whatever it is sent.
#include <algorithm>

#include "tests/bridge/filter_rig.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using test::FilterRig;
using test::kMs;
using test::kOneUp;

namespace {

constexpr double kRampTicks = 500.0;

// Off for so many ticks in the middle of a contact.
FilterRig rig_after_outage(int ticks, double newton) {
  FilterRig rig;
  rig.engage(newton * kOneUp);
  REQUIRE(rig.shown.norm() == Approx(newton));
  rig.off = true;
  for (int i = 0; i < ticks; ++i) {
    REQUIRE(rig.ticks(1, newton * kOneUp).isZero(0.0));
    REQUIRE(rig.torque.isZero(0.0));
  }
  rig.off = false;
  return rig;
}

}  // namespace

TEST_CASE("motors that are off: nothing is sent at once, and the force rises from there") {
  const int ticks = GENERATE(1, 3, 400);
  CAPTURE(ticks);
  FilterRig rig = rig_after_outage(ticks, 3.0);
  double rise = 0.0;
  for (int i = 0; i < 700; ++i) {
    const double before = rig.shown.norm();
    rig.ticks(1, 3.0 * kOneUp);
    rise = std::max(rise, rig.shown.norm() - before);
  }
  CHECK(rise < 1.001 * 3.0 / kRampTicks);
  CHECK(rig.shown.norm() == Approx(3.0));
  CHECK(rig.filter.counts().trips == 0);
  CHECK(rig.filter.counts().faults == 0);
}

TEST_CASE("motors that are off: a torque likewise") {
  FilterRig rig({}, {.max_torque = 0.15});
  rig.demand.torque = Vector3(0, 0, 0.1);
  rig.ticks(600, kOneUp);
  REQUIRE(rig.torque.norm() == Approx(0.1));
  rig.off = true;
  rig.ticks(1, kOneUp);
  CHECK(rig.torque.isZero(0.0));
  rig.off = false;
  double rise = 0.0;
  for (int i = 0; i < 700; ++i) {
    const double before = rig.torque.norm();
    rig.ticks(1, kOneUp);
    rise = std::max(rise, rig.torque.norm() - before);
  }
  CHECK(rise < 1.001 * 0.1 / kRampTicks);
  CHECK(rig.torque.norm() == Approx(0.1));
}

TEST_CASE("motors that are off take nothing from the hand, and may have given before they were") {
  const double way = GENERATE(1e-4, -1e-4);
  FilterRig rig;
  rig.demand.contact = ContactState::kHeld;
  rig.engage(kOneUp);
  const double before = rig.filter.port_energy();
  rig.off = true;
  rig.tip.y() += way;
  rig.tick();
  CHECK(rig.filter.port_energy() == Approx(before - std::max(0.0, way)));
  const double first = rig.filter.port_energy();
  for (int i = 0; i < 20; ++i) {
    rig.tip.y() += way;
    rig.tick();
  }
  CHECK(rig.filter.port_energy() == first);
}

TEST_CASE("motors that are off arm no filter, and end no fault") {
  FilterRig rig;
  rig.engage(kOneUp);
  rig.off = true;
  rig.filter.fail();
  rig.ticks(3, kOneUp);
  CHECK(rig.filter.state() == FilterState::kFault);
  rig.filter.disarm();
  rig.ticks(3, kOneUp);
  rig.off = false;
  CHECK(rig.ticks(300, kOneUp).isZero(0.0));
  CHECK(rig.filter.state() == FilterState::kDisarmed);
}
