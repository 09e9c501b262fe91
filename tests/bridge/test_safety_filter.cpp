#include <limits>

#include "tests/bridge/filter_rig.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using test::FilterRig;
using test::kMs;
using test::kOneUp;

TEST_CASE("safety filter: states, from disarmed to a fault and back") {
  FilterRig rig;
  rig.filter.disarm();
  CHECK(rig.filter.state() == FilterState::kDisarmed);
  rig.filter.arm();
  CHECK(rig.filter.state() == FilterState::kArmed);
  rig.tick();
  CHECK(rig.filter.state() == FilterState::kArmed);  // there is no demand
  rig.ticks(1, Vector3::Zero());
  CHECK(rig.filter.state() == FilterState::kEngaged);
  rig.ticks(20, kOneUp);
  CHECK(rig.shown == kOneUp);
  for (int i = 0; i < 25; ++i) rig.tick();
  CHECK(rig.filter.state() == FilterState::kFading);
  CHECK(rig.shown.norm() == Approx(24.0 / 29.0));
  for (int i = 0; i < 25; ++i) rig.tick();
  CHECK(rig.filter.state() == FilterState::kArmed);
  CHECK(rig.shown == Vector3::Zero());
  rig.filter.fail();
  rig.filter.arm();
  CHECK(rig.filter.state() == FilterState::kFault);
  CHECK(rig.filter.counts().faults == 1);
  rig.filter.disarm();
  rig.filter.arm();
  rig.ticks(1, Vector3::Zero());
  CHECK(rig.ticks(10, kOneUp) == kOneUp);
}

TEST_CASE(
    "safety filter: armed anew with a small demand the force is back at once, with a large one "
    "slowly") {
  for (const double begin : {0.2, 1.0}) {
    FilterRig rig;
    rig.engage(kOneUp);
    rig.demand.linked = false;
    for (int i = 0; i < 40; ++i) rig.tick();
    rig.filter.arm();
    rig.ticks(1, begin * kOneUp);
    rig.ticks(10, kOneUp);
    CHECK(rig.shown.norm() == Approx(begin < 0.3 ? 1.0 : 0.022));
  }
}

TEST_CASE("safety filter: a fade that is caught goes on from where it is") {
  FilterRig rig;
  rig.engage(kOneUp);
  for (int i = 0; i < 35; ++i) rig.tick();
  const double left = 14.0 / 29.0;
  CHECK(rig.shown.norm() == Approx(left));
  CHECK(rig.ticks(1, kOneUp).norm() == Approx(left + 0.002));
  CHECK(rig.ticks(257, kOneUp).norm() == Approx(left + 0.516));
  CHECK(rig.ticks(2, kOneUp).norm() == 1.0);
}

TEST_CASE("safety filter: a demand is trusted for its horizon, and none for more than 50 ms") {
  FilterRig rig;
  rig.engage(kOneUp);
  rig.demand_now(kOneUp);
  rig.demand.horizon_ns = 10'000 * kMs;
  rig.tick();
  for (int i = 0; i < 50; ++i) CHECK(rig.tick() == kOneUp);
  CHECK(rig.tick().norm() < 1.0);
  for (int i = 0; i < 29; ++i) rig.tick();
  CHECK(rig.shown == Vector3::Zero());
}

TEST_CASE("safety filter: a demand that comes too late does not make the force last longer") {
  for (const bool late : {false, true}) {
    FilterRig rig;
    rig.engage(kOneUp);
    const std::int64_t last_ns = rig.now_ns;
    while (rig.now_ns < last_ns + 49 * kMs) {
      if (late && rig.now_ns >= last_ns + 40 * kMs) rig.demand.sample_time_ns = last_ns + 2 * kMs;
      CHECK(rig.shown.norm() > 0.0);
      rig.tick();
    }
    CHECK(rig.shown == Vector3::Zero());
  }
}

TEST_CASE("safety filter: demands that always come too late show nothing") {
  FilterRig rig;
  for (int i = 0; i < 200; ++i) {
    rig.demand_now(kOneUp);
    rig.demand.sample_time_ns -= ForceDemand::kHoldHorizonNs + kMs;
    CHECK(rig.tick() == Vector3::Zero());
  }
}

TEST_CASE("safety filter: a hand that is fast in free air has lost nothing when it touches") {
  FilterRig rig;
  rig.ticks(2, Vector3::Zero());
  for (int i = 0; i < 100; ++i) {
    rig.tip.x() += 2e-3;
    rig.ticks(1, Vector3::Zero());
  }
  CHECK(rig.ticks(10, kOneUp) == kOneUp);
  CHECK(rig.filter.counts().trips == 0);
  // One that is still fast when it touches has.
  for (int i = 0; i < 10; ++i) {
    rig.tip.x() += 2e-3;
    rig.ticks(1, kOneUp);
  }
  CHECK(rig.filter.counts().trips == 8);
  CHECK(rig.ticks(90, kOneUp) == Vector3::Zero());
}

TEST_CASE("safety filter: what the device says of its motors counts") {
  FilterRig rig;
  rig.engage(3.0 * kOneUp);
  for (int i = 0; i < 1000; ++i) {
    rig.demand_now(3.0 * kOneUp);
    rig.now_ns += kMs;
    rig.shown = rig.filter.step(rig.now_ns, {.motor_temperature = 1.0}, rig.demand).force;
  }
  CHECK(rig.shown.norm() == Approx(0.88));
}

// How far one wrong frame of 8 N, 2 ms long, moves the force that is shown.
TEST_CASE("safety filter: one wrong frame of 8 N moves the force by at most 0.6 N") {
  constexpr int kTurns = 64;
  double farthest = 0.0;
  for (const double shown : {0.0, 0.5, 1.6, 3.3}) {
    for (int turn = 0; turn < kTurns; ++turn) {
      const double angle = 2.0 * M_PI * turn / kTurns;
      FilterRig rig;
      rig.demand.contact = ContactState::kHeld;
      rig.engage(shown * kOneUp);
      const Vector3 before = rig.shown;
      REQUIRE(before.norm() == Approx(shown));
      rig.ticks(2, Vector3(8.0 * std::sin(angle), 8.0 * std::cos(angle), 0));
      for (int after = 0; after < 20; ++after) {
        farthest = std::max(farthest, (rig.shown - before).norm());
        rig.ticks(1, shown * kOneUp);
      }
      CHECK(rig.shown.isApprox(before));
    }
  }
  CHECK(farthest <= 0.6 + 1e-9);
  CHECK(farthest > 0.59);
}

TEST_CASE("rate limit: a force turns slowly, falls fast, and goes through zero at both rates") {
  const RateLimits limits;
  const Vector3 x(1, 0, 0);
  CHECK(limit_rate(x, 2 * x, limits, 1e-3).isApprox(1.3 * x));
  CHECK(limit_rate(x, Vector3::Zero(), limits, 1e-3) == Vector3::Zero());
  CHECK(limit_rate(3 * x, Vector3::Zero(), limits, 1e-3).isApprox(1.8 * x));
  CHECK(limit_rate(x, -x, limits, 1e-3).isApprox(0.7 * x));
  CHECK(limit_rate(x, -0.4 * x, limits, 1e-3).isApprox(-0.05 * x));
  CHECK(limit_rate(3 * x, Vector3::Zero(), limits, 1.0).isApprox(0.6 * x));  // 2 ms count
  CHECK(limit_rate(x, 2 * x, limits, -1.0) == x);
  CHECK(limit_rate(x, x, limits, 0.0) == x);
}

TEST_CASE("safety filter: a force of now gives next to nothing that nobody put in") {
  // Pressed in by 1 cm, where the device shows 3.3 N of 9, and back out over 4 cm by 1.5 N: 27 mJ
  // more than the device took.
  const auto lowest = [](Guards guards) {
    FilterRig rig(guards);
    rig.engage(Vector3::Zero());
    rig.demand.solved_here = true;
    double energy = 0.0;
    double least = 0.0;
    for (int i = 0; i < 1000; ++i) {
      rig.tip.y() += i < 200 ? -5e-5 : 5e-5;
      energy -= rig.shown.y() * (i < 200 ? -5e-5 : 5e-5);
      least = std::min(least, energy);
      rig.demand_now((i < 200 ? 9.0 : 1.5) * kOneUp);
      rig.demand.solved_ns = rig.demand.sample_time_ns;
      rig.tick();
    }
    return least;
  };
  CHECK(lowest({}) > -1.001 * PassivityLimits{}.credit);
  CHECK(lowest(Guards{}.without(Guard::kPassivity)) < -20e-3);
}

TEST_CASE("safety filter: a force of now by which another hand pushes is shown in full") {
  FilterRig rig;
  rig.engage(Vector3::Zero());
  rig.demand.solved_here = true;
  for (int i = 0; i < 3000; ++i) {
    rig.tip.y() += 1e-4;
    rig.demand_now(kOneUp);
    rig.demand.solved_ns = rig.demand.sample_time_ns;
    rig.tick();
    if (i > 100) REQUIRE(rig.shown.y() == Approx(1.0));
  }
}

TEST_CASE("safety filter: a late force by which another hand pushes is not lowered") {
  FilterRig rig;
  rig.engage(Vector3::Zero());
  for (int i = 0; i < 3000; ++i) {
    rig.tip.y() += 1e-4;
    rig.demand_now(kOneUp);
    rig.demand.sample_time_ns -= 10 * kMs;
    rig.tick();
  }
  CHECK(rig.filter.gain() == 1.0);
}
