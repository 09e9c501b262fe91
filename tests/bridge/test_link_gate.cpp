#include "device_bridge/safety/arming.hpp"
#include "tests/bridge/filter_rig.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using test::kOneUp;

TEST_CASE("a link gate tells the share of the last hundred ticks, those to come being bad") {
  LinkGate gate;
  CHECK(gate.success_rate() == 0.0);
  for (int i = 0; i < 50; ++i) gate.tick(true);
  CHECK(gate.success_rate() == 0.5);
  for (int i = 0; i < 60; ++i) gate.tick(true);
  CHECK(gate.success_rate() == 1.0);
  for (int i = 0; i < 30; ++i) gate.tick(false);
  CHECK(gate.success_rate() == 0.7);
  for (int i = 0; i < 100; ++i) gate.tick(i % 2 == 0);
  CHECK(gate.success_rate() == 0.5);
}

namespace {

constexpr FilterLimits kGated{.needed_success = 0.9};

/// One tick; the newest demand is too old in every one of which `good` is false.
void tick(test::FilterRig& rig, bool good) {
  if (good) rig.demand_now(kOneUp);
  rig.tick();
}

}  // namespace

TEST_CASE("a filter that is told to arm does so when the link is good enough") {
  test::FilterRig rig({}, kGated);
  for (int i = 0; i < 89; ++i) tick(rig, true);
  CHECK(rig.filter.state() == FilterState::kDisarmed);
  CHECK(rig.shown == Vector3::Zero());
  CHECK(rig.filter.success_rate() == 0.89);
  tick(rig, true);
  CHECK(rig.filter.state() == FilterState::kEngaged);
}

TEST_CASE("a filter does not arm on a link that answers too seldom") {
  test::FilterRig rig({}, kGated);
  // A demand every 24 ms is too old in 4 of 24 ticks.
  for (int i = 0; i < 2000; ++i) tick(rig, i % 24 == 0);
  CHECK(rig.filter.state() == FilterState::kDisarmed);
  CHECK(rig.filter.success_rate() < 0.9);
  CHECK(rig.filter.success_rate() > 0.8);
}

TEST_CASE("a filter that is armed stays so on a link that gets worse") {
  test::FilterRig rig({}, kGated);
  for (int i = 0; i < 100; ++i) tick(rig, true);
  for (int i = 0; i < 200; ++i) tick(rig, false);
  CHECK(rig.filter.state() == FilterState::kArmed);
  tick(rig, true);
  CHECK(rig.filter.state() == FilterState::kEngaged);
}

TEST_CASE("a filter that was disarmed arms when the link is good and it is told to, not before") {
  test::FilterRig rig({}, kGated);
  rig.filter.disarm();
  for (int i = 0; i < 200; ++i) tick(rig, true);
  CHECK(rig.filter.state() == FilterState::kDisarmed);
  rig.filter.arm();
  CHECK(rig.filter.state() == FilterState::kArmed);
}

TEST_CASE("a fault before the link is good enough stays a fault") {
  test::FilterRig rig({}, kGated);
  tick(rig, true);
  rig.filter.fail();
  for (int i = 0; i < 200; ++i) tick(rig, true);
  CHECK(rig.filter.state() == FilterState::kFault);
  CHECK(rig.shown == Vector3::Zero());
}
