// The safety filter of a device that renders torque.
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "common/motion/rigid_body.hpp"
#include "device_bridge/virtual_stylus.hpp"
#include "tests/bridge/filter_rig.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using test::FilterRig;
using test::kMs;
using test::kOneUp;

namespace {

constexpr double kLargest = 0.15;  // [N m]
const Vector3 kTwist(0, 0, 0.05);  // [N m]

struct TorqueRig : FilterRig {
  explicit TorqueRig(double max_torque = kLargest) : FilterRig({}, {.max_torque = max_torque}) {
    demand.contact = ContactState::kFree;  // as of a tool
    demand.normal.setZero();
  }
  /// So many ticks, each with a demand of its own moment.
  const Vector3& twist(int count, const Vector3& wanted, const Vector3& force = Vector3::Zero()) {
    demand.torque = wanted;
    ticks(count, force);
    return torque;
  }
  void engage_twist(const Vector3& wanted, const Vector3& force = Vector3::Zero()) {
    twist(2, Vector3::Zero());
    twist(30, wanted, force);
  }
};

/// A wall of so many N/m, whose force comes late, in the same run met by a way and by a turn.
class LateWall {
 public:
  LateWall(int delay_ticks, double stiffness)
      : stiffness_(stiffness), late_(static_cast<std::size_t>(delay_ticks), 0.0) {}
  double push(double way) {
    late_.push_back(std::max(0.0, -stiffness_ * way));
    const double now = late_.front();
    late_.pop_front();
    return now;
  }

 private:
  double stiffness_;
  std::deque<double> late_;
};

/// A hand of the default's presses a stylus onto it, lets the link go, and comes back.
class Pressing {
 public:
  explicit Pressing(bool turned) : turned_(turned), rig_({}, limits()) {
    rig_.demand.contact = ContactState::kHeld;
  }
  /// The force in the tick, that of a turn in the hand [N].
  double tick(int i) {
    const double target = i % 1000 < 100 ? 0.005 : -0.01;
    const Quaternion turn = rotation_from_vector(Vector3(0, target / kLever, 0));
    if (turned_) {
      wrist_.advance(1e-3, turn, rig_.torque);
      rig_.orientation = wrist_.orientation();
    } else {
      hand_.advance(1e-3, Vector3(0, target, 0), rig_.shown);
      rig_.tip = hand_.position();
    }
    const double push = wall_.push(way());
    rig_.demand_now(turned_ ? Vector3::Zero() : Vector3(0, push, 0));
    if (turned_) rig_.demand.torque = Vector3(0, kLever * push, 0);
    rig_.demand.sample_time_ns -= kDelay * kMs;
    rig_.demand.linked = i % 1500 < 1400;
    rig_.tick();
    return turned_ ? rig_.torque.y() / kLever : rig_.shown.y();
  }
  double way() const {
    return turned_ ? kLever * rotation_vector(wrist_.orientation()).y() : hand_.position().y();
  }
  const SafetyFilter& filter() const { return rig_.filter; }

 private:
  static constexpr int kDelay = 10;
  static FilterLimits limits() {
    return {.max_torque = 3.3 * kLever, .continuous_torque = 0.88 * kLever};
  }
  bool turned_;
  FilterRig rig_;
  VirtualHand hand_{HandParameters{}, Vector3(0, 0.005, 0)};
  VirtualWrist wrist_{TurnParameters{}, rotation_from_vector(Vector3(0, 0.005 / kLever, 0))};
  LateWall wall_{kDelay, 1500.0};
};

}  // namespace

// All guards but those of direction and of contacts that are solved here see it alike.
TEST_CASE("filter of torque: a turn is filtered as the way that the hand makes in it") {
  Pressing moved(false);
  Pressing turned(true);
  double peak = 0.0;
  for (int i = 0; i < 6000; ++i) {
    const double force = moved.tick(i);
    peak = std::max(peak, force);
    REQUIRE(std::abs(turned.tick(i) - force) < 1e-9);
    REQUIRE(std::abs(turned.way() - moved.way()) < 1e-9);
    REQUIRE(turned.filter().state() == moved.filter().state());
    REQUIRE(turned.filter().gain() == Approx(moved.filter().gain()));
    REQUIRE(std::abs(turned.filter().port_energy() - moved.filter().port_energy()) < 1e-12);
    REQUIRE(turned.filter().warmth() == Approx(moved.filter().warmth()));
  }
  CHECK(peak > 1.0);
  CHECK(moved.filter().gain() < 1.0);
}

TEST_CASE("filter of torque: largest torque and its rates, and force and torque apart") {
  TorqueRig rig;
  rig.engage_twist(Vector3::Zero());
  double fastest = 0.0;
  const auto follow = [&](const Vector3& torque, const Vector3& force) {
    for (int i = 0; i < 40; ++i) {
      const Vector3 before = rig.torque;
      rig.twist(1, torque, force);
      fastest = std::max(fastest, (rig.torque - before).norm());
    }
  };
  follow(Vector3(1, 1, 0), kOneUp);
  CHECK(fastest == Approx(0.015));  // 15 N m/s
  CHECK(rig.torque.isApprox(kLargest * Vector3(1, 1, 0).normalized()));
  CHECK(rig.shown.isApprox(kOneUp));
  fastest = 0.0;
  follow(Vector3::Zero(), kOneUp);
  CHECK(fastest <= 0.06);  // 60 N m/s
  CHECK(fastest > 0.055);
  follow(kTwist, 9.0 * kOneUp);
  CHECK(rig.torque.isApprox(kTwist));
  CHECK(rig.shown.norm() == Approx(3.3));
}

TEST_CASE("filter of torque: warm motors give the continuous torque") {
  TorqueRig rig;
  rig.engage_twist(0.1 * kOneUp);
  for (int i = 0; i < 300'000; ++i) rig.twist(1, 0.1 * kOneUp, kOneUp);
  CHECK(rig.torque.norm() == Approx(0.05).epsilon(1e-3));
  CHECK(rig.shown.norm() < 1.0);  // 1 N is more than its motors bear, too
}

TEST_CASE("filter of torque: a device that renders none gets none, however it turns") {
  TorqueRig rig(0.0);
  rig.engage_twist(kTwist, kOneUp);
  CHECK(rig.torque.isZero(0.0));
  rig.orientation = Quaternion(0, 1, 0, 0);
  rig.twist(1, kTwist, kOneUp);
  CHECK(rig.shown.isApprox(kOneUp));
  CHECK(rig.filter.counts().trips == 0);
}

TEST_CASE("filter of torque: what is no number changes nothing, and is a fault in readings") {
  const double number = GENERATE(std::nan(""), HUGE_VAL);
  TorqueRig rig;
  rig.engage_twist(kTwist, kOneUp);
  REQUIRE(rig.torque.isApprox(kTwist));
  for (int i = 0; i < 5; ++i) {
    rig.twist(1, Vector3(number, number, 0), kOneUp);
    CHECK(rig.torque.isApprox(kTwist));
    CHECK(rig.shown.isApprox(kOneUp));
  }
  CHECK(rig.filter.counts().demands == 5);
  rig.orientation.x() = number;
  rig.twist(2, kTwist, kOneUp);
  CHECK(rig.torque.isApprox(kTwist));
  rig.twist(8, kTwist, kOneUp);
  CHECK(rig.filter.state() == FilterState::kFault);
  CHECK(rig.torque.isZero(0.0));
  CHECK(rig.shown.isZero(0.0));
}

TEST_CASE("filter of torque: a jump of the orientation, and a hand that turns too fast, drop all") {
  const double jump = GENERATE(1.0, 0.022);  // [rad], 1 kHz
  TorqueRig rig;
  rig.engage_twist(kTwist, kOneUp);
  for (int i = 1; i <= (jump == 1.0 ? 1 : 4); ++i) {
    rig.orientation = rotation_from_vector(Vector3(0, 0, i * jump));
    rig.twist(1, kTwist, kOneUp);
  }
  CHECK(rig.filter.counts().trips > 0);
  rig.twist(3, kTwist, kOneUp);
  CHECK(rig.torque.isZero(0.0));
  CHECK(rig.shown.isZero(0.0));
}

TEST_CASE("filter of torque: a lost link and an old demand fade both alike, to zero") {
  const bool lost = GENERATE(true, false);
  TorqueRig rig;
  rig.engage_twist(kTwist, kOneUp);
  rig.demand.linked = !lost;
  if (!lost) rig.now_ns += 19 * kMs;  // 20 ms old in the next tick
  double share = 1.0;
  int ticks = 0;
  for (; ticks < 100 && rig.torque.norm() > 0.0; ++ticks) {
    rig.tick();
    CHECK(rig.torque.norm() / kTwist.norm() == Approx(rig.shown.norm()).margin(1e-12));
    CHECK(rig.torque.norm() <= share * kTwist.norm());
    share = rig.torque.norm() / kTwist.norm();
  }
  CHECK(ticks > 20);
  CHECK(ticks <= 31);
  CHECK(rig.shown.isZero(0.0));
}

TEST_CASE("filter of torque: while it fades it damps turns") {
  TorqueRig rig;
  rig.engage_twist(kTwist);
  rig.demand.linked = false;
  double work = 0.0;
  for (int i = 1; i <= 30; ++i) {
    rig.orientation = rotation_from_vector(Vector3(6e-3 * i, 0, 0));  // across the torque
    rig.tick();
    work += 6e-3 * rig.torque.x();
  }
  CHECK(work < -1e-3);
}

// A rod of 10 cm, held by one end in a hand of six degrees of freedom, whose other end meets a wall
// with a force that comes late.
TEST_CASE("filter of torque: a late wall at the end of a lever gives the hand next to no energy") {
  constexpr double kArm = 0.1;  // [m]
  const auto lowest = [&](Guards guards, int delay, double stiffness) {
    FilterRig rig(guards, {.max_torque = 0.5});
    rig.demand.contact = ContactState::kFree;
    VirtualHand hand(HandParameters{}, Vector3(0, 0.005, 0));
    VirtualWrist wrist(TurnParameters{}, Quaternion::Identity());
    std::deque<Wrench> late(static_cast<std::size_t>(delay));
    double energy = 0.0;
    double least = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const Vector3 before = hand.position();
      const Quaternion turned = wrist.orientation();
      hand.advance(1e-3, Vector3(0, i < 100 ? 0.005 : -0.01, 0), rig.shown);
      wrist.advance(1e-3, Quaternion::Identity(), rig.torque);
      energy -= work(
          {rig.shown, rig.torque},
          {hand.position() - before, rotation_vector(wrist.orientation() * turned.conjugate())});
      least = std::min(least, energy);
      rig.tip = hand.position();
      rig.orientation = wrist.orientation();
      const Vector3 arm = wrist.orientation() * Vector3(kArm, 0, 0);
      const Vector3 push(0, std::max(0.0, -stiffness * (hand.position() + arm).y()), 0);
      late.push_back({push, arm.cross(push)});
      rig.demand_now(late.front().force);
      rig.demand.torque = late.front().torque;
      rig.demand.sample_time_ns -= delay * kMs;
      late.pop_front();
      rig.tick();
    }
    return least;
  };
  // At the end of the rod the hand is lighter: a wall is as stiff for it as a stiffer one for a
  // tip.
  const double mass = HandParameters{}.mass;
  const double lighter = 1.0 / (1.0 + kArm * kArm * mass / TurnParameters{}.inertia);
  for (const int delay : {0, 1, 2, 4, 10, 18}) {
    for (const double stiffness : {200.0, 400.0, 2000.0}) {
      CAPTURE(delay, stiffness);
      const bool soft = stiffness <= 400.0 && delay <= 2;
      CHECK(lowest({}, delay, lighter * stiffness) > (soft ? -1e-3 : -20e-3));
    }
  }
  const Guards bare = Guards{}.without(Guard::kOscillation).without(Guard::kPassivity);
  CHECK(lowest(bare, 10, lighter * 2000.0) < -0.5);
}
