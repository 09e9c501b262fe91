#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <set>

#include "device_bridge/virtual_stylus.hpp"
#include "tests/bridge/filter_rig.hpp"
#include "tests/support/catch.hpp"

// What each guard of the safety filter is there for, as something that holds with it and does not
// hold without it.

using namespace irdm;
using test::FilterRig;
using test::kMs;
using test::kOneUp;

namespace {

const double kNaN = std::numeric_limits<double>::quiet_NaN();

// Ticks until no force is shown any more.
int ticks_to_zero(FilterRig& rig, int most = 1000) {
  int ticks = 0;
  while (rig.shown != Vector3::Zero() && ticks < most) {
    rig.tick();
    ++ticks;
  }
  return ticks;
}

bool readings_that_are_no_numbers_end_in_a_fault(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  rig.tip.x() = kNaN;
  if (rig.ticks(2, kOneUp) != kOneUp) return false;
  rig.ticks(5, kOneUp);
  return rig.shown == Vector3::Zero() && rig.filter.state() == FilterState::kFault;
}

bool a_jump_of_the_device_drops_the_force(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  rig.tip.x() += 0.05;
  if (rig.ticks(1, kOneUp) != Vector3::Zero()) return false;
  return rig.ticks(90, kOneUp) == Vector3::Zero() && rig.ticks(510, kOneUp) == kOneUp;
}

bool time_that_goes_back_is_a_fault_and_a_long_gap_drops_the_force(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  rig.now_ns -= 2 * kMs;
  rig.ticks(3, kOneUp);
  if (rig.filter.state() != FilterState::kFault) return false;
  FilterRig other(guards);
  other.engage(kOneUp);
  other.now_ns += 500 * kMs;
  return other.ticks(2, kOneUp) == Vector3::Zero();
}

bool a_hand_that_is_too_fast_feels_no_force(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  for (int i = 0; i < 2; ++i) {
    rig.tip.x() += 1.5e-3;
    rig.ticks(1, kOneUp);
  }
  if (rig.shown.norm() < 0.9) return false;
  for (int i = 0; i < 2; ++i) {
    rig.tip.x() += 1.5e-3;
    rig.ticks(1, kOneUp);
  }
  return rig.shown == Vector3::Zero();
}

bool a_demand_that_is_no_number_changes_nothing(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  rig.ticks(1, Vector3(0, kNaN, 0));
  if (rig.shown != kOneUp) return false;
  rig.ticks(1, Vector3(0, std::numeric_limits<double>::infinity(), 0));
  return rig.shown == kOneUp;
}

bool demands_of_the_past_and_the_future_change_nothing(Guards guards) {
  for (const std::int64_t off_ns : {-10 * kMs, 10 * kMs}) {
    FilterRig rig(guards);
    rig.engage(kOneUp);
    rig.demand_now(3.0 * kOneUp);
    rig.demand.sample_time_ns += off_ns;
    if (rig.tick() != kOneUp) return false;
  }
  return true;
}

bool a_force_is_full_for_20_ms_and_zero_within_50_ms(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  for (int ms = 1; ms <= 20; ++ms) {
    if (rig.tick() != kOneUp) return false;
  }
  return rig.tick().norm() < 1.0 && ticks_to_zero(rig) == 28;
}

bool a_lost_link_fades_the_force_at_once(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  rig.demand.linked = false;
  return ticks_to_zero(rig) <= 31;
}

bool nothing_is_shown_before_arming(Guards guards) {
  FilterRig rig(guards);
  rig.filter.disarm();
  return rig.ticks(100, kOneUp) == Vector3::Zero();
}

bool a_force_that_comes_back_rises_within_half_a_second(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  rig.demand.linked = false;
  for (int i = 0; i < 100; ++i) rig.tick();
  return rig.ticks(100, kOneUp).norm() <= 0.201 && rig.ticks(400, kOneUp).norm() == Approx(1.0);
}

bool a_fault_stays(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  rig.filter.fail();
  rig.filter.arm();
  return rig.ticks(2000, kOneUp) == Vector3::Zero();
}

bool a_touch_does_not_pull(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  if (rig.ticks(20, Vector3(0.1, -1, 0)) != Vector3::Zero()) return false;
  rig.demand.contact = ContactState::kHeld;
  return rig.ticks(20, Vector3(0.1, -1, 0)).isApprox(Vector3(0.1, -1, 0));
}

struct Pressed {
  double lowest = 0.0;  ///< energy that the port has had [J]
  double gain = 1.0;    ///< at the end
};

// A hand presses on a wall whose force arrives late.
Pressed press(Guards guards, int delay_ticks, double stiffness) {
  FilterRig rig(guards);
  VirtualHand hand({.mass = 0.12, .damping = 2.0, .stiffness = 300.0}, Vector3(0, 0.005, 0));
  std::deque<Vector3> on_the_way(static_cast<std::size_t>(delay_ticks), Vector3::Zero());
  double energy = 0.0;
  Pressed pressed;
  for (int i = 0; i < 3000; ++i) {
    const Vector3 before = hand.position();
    hand.advance(1e-3, Vector3(0, i < 100 ? 0.005 : -0.01, 0), rig.shown);
    energy -= rig.shown.dot(hand.position() - before);
    pressed.lowest = std::min(pressed.lowest, energy);
    rig.tip = hand.position();
    on_the_way.emplace_back(0.0, std::max(0.0, -stiffness * rig.tip.y()), 0.0);
    rig.demand_now(on_the_way.front());
    rig.demand.sample_time_ns -= delay_ticks * kMs;
    on_the_way.pop_front();
    rig.tick();
  }
  pressed.gain = rig.filter.gain();
  return pressed;
}

double lowest_port_energy(Guards guards, int delay_ticks, double stiffness) {
  return press(guards, delay_ticks, stiffness).lowest;
}

bool a_late_wall_gives_no_energy(Guards guards) {
  return lowest_port_energy(guards, 2, 400.0) > -1e-3;
}

bool a_stiff_wall_that_is_late_does_not_shake_the_hand(Guards guards) {
  return lowest_port_energy(guards, 10, 1500.0) > -20e-3;
}

bool a_force_that_fades_damps(Guards guards) {
  FilterRig rig(guards);
  rig.engage(kOneUp);
  rig.demand.linked = false;
  double work = 0.0;
  for (int i = 0; i < 30; ++i) {
    rig.tip.x() += 3e-4;  // across the force
    work += 3e-4 * rig.tick().x();
  }
  return work < -1e-3;
}

double largest_change(FilterRig& rig, const Vector3& force) {
  double largest = 0.0;
  for (int i = 0; i < 40; ++i) {
    const Vector3 before = rig.shown;
    largest = std::max(largest, (rig.ticks(1, force) - before).norm());
  }
  return largest;
}

bool a_force_rises_by_at_most_300_N_a_second(Guards guards) {
  FilterRig rig(guards);
  rig.engage(Vector3::Zero());
  if (largest_change(rig, Vector3(0, 8, 0)) > 0.3000001) return false;
  return largest_change(rig, Vector3(8, 0, 0)) <= 0.3000001;
}

bool a_force_falls_by_at_most_1200_N_a_second(Guards guards) {
  FilterRig rig(guards);
  rig.engage(3.0 * kOneUp);
  const double fastest = largest_change(rig, Vector3::Zero());
  return fastest <= 1.2 && fastest > 1.1;
}

bool no_force_is_larger_than_the_device_can_give(Guards guards) {
  FilterRig rig(guards);
  rig.engage(Vector3::Zero());
  return rig.ticks(100, Vector3(6, 6, 0)).norm() == Approx(3.3);
}

bool a_motor_that_works_for_long_gives_the_continuous_force(Guards guards) {
  FilterRig rig(guards);
  rig.engage(3.3 * kOneUp);
  // In full, warmth goes towards the square of what the force is of the continuous one, by a lag of
  // 60 s, and the force is lowered from 0.7 on.
  const double towards = 3.3 * 3.3 / (0.88 * 0.88);
  const double full = 60.0 * std::log((towards - rig.filter.warmth()) / (towards - 0.7));
  const auto in_full = static_cast<int>(1e3 * full);
  if (rig.ticks(in_full - 2, 3.3 * kOneUp).norm() < 3.3 * (1 - 1e-12)) return false;
  if (rig.ticks(4, 3.3 * kOneUp).norm() > 3.3 - 1e-6) return false;
  double most = 0.0;
  for (int i = 0; i < 600'000; ++i) {
    rig.ticks(1, 3.3 * kOneUp);
    most = std::max(most, rig.filter.warmth());
  }
  // There it stays: the continuous force keeps the motors at 1.
  return std::abs(rig.shown.norm() - 0.88) < 1e-6 && most <= 1.0 && most > 1.0 - 1e-6;
}

struct Case {
  Guard guard;
  const char* name;
  bool (*holds)(Guards);
};

constexpr std::array<Case, kGuardCount> kCases{{
    {Guard::kReadingFinite, "finite reading", readings_that_are_no_numbers_end_in_a_fault},
    {Guard::kReadingJump, "jump", a_jump_of_the_device_drops_the_force},
    {Guard::kClock, "clock", time_that_goes_back_is_a_fault_and_a_long_gap_drops_the_force},
    {Guard::kSpeed, "speed", a_hand_that_is_too_fast_feels_no_force},
    {Guard::kFrameFinite, "finite demand", a_demand_that_is_no_number_changes_nothing},
    {Guard::kFrameOrder, "order", demands_of_the_past_and_the_future_change_nothing},
    {Guard::kAge, "age", a_force_is_full_for_20_ms_and_zero_within_50_ms},
    {Guard::kLink, "link", a_lost_link_fades_the_force_at_once},
    {Guard::kArming, "arming", nothing_is_shown_before_arming},
    {Guard::kRamp, "ramp", a_force_that_comes_back_rises_within_half_a_second},
    {Guard::kLatch, "latch", a_fault_stays},
    {Guard::kPushOnly, "push only", a_touch_does_not_pull},
    {Guard::kPassivity, "passivity", a_late_wall_gives_no_energy},
    {Guard::kOscillation, "oscillation", a_stiff_wall_that_is_late_does_not_shake_the_hand},
    {Guard::kFadeDamping, "damping of a fade", a_force_that_fades_damps},
    {Guard::kRiseLimit, "rise", a_force_rises_by_at_most_300_N_a_second},
    {Guard::kFallLimit, "fall", a_force_falls_by_at_most_1200_N_a_second},
    {Guard::kForceLimit, "largest force", no_force_is_larger_than_the_device_can_give},
    {Guard::kThermal, "warm motors", a_motor_that_works_for_long_gives_the_continuous_force},
}};

}  // namespace

TEST_CASE("safety filter: every guard does its work, and is missed when it is taken off") {
  std::set<Guard> seen;
  for (const Case& c : kCases) {
    seen.insert(c.guard);
    CAPTURE(c.name);
    CHECK(c.holds(Guards{}));
    CHECK_FALSE(c.holds(Guards{}.without(c.guard)));
  }
  CHECK(seen.size() == kGuardCount);
}

// A second line of defence, behind the look at what is demanded.
TEST_CASE("safety filter: what is no number is never shown, even where demands are not looked at") {
  FilterRig rig(Guards{}.without(Guard::kFrameFinite));
  rig.engage(kOneUp);
  REQUIRE(rig.shown.y() > 0.5);
  const double number = GENERATE(std::nan(""), HUGE_VAL, -HUGE_VAL);
  for (int i = 0; i < 50; ++i) REQUIRE(rig.ticks(1, Vector3(0, number, 0)).allFinite());
  CHECK(rig.shown.isZero(0.0));
}

TEST_CASE("safety filter: a late wall gives next to no energy, however late") {
  for (const int delay : {0, 1, 2, 4, 10, 18}) {
    for (const double stiffness : {100.0, 200.0, 300.0, 400.0}) {
      CAPTURE(delay, stiffness);
      CHECK(lowest_port_energy({}, delay, stiffness) > (delay <= 2 ? -1e-3 : -20e-3));
    }
  }
  // Without the controller it shakes the hand.
  const Guards no_gain = Guards{}.without(Guard::kOscillation);
  CHECK(lowest_port_energy(no_gain.without(Guard::kPassivity), 10, 400.0) < -1.0);
}

TEST_CASE("safety filter: a wall that is near is shown in full, however stiff") {
  for (const int delay : {0, 1, 2, 4}) {
    for (const double stiffness : {100.0, 200.0, 400.0, 1000.0, 2000.0}) {
      if (delay > 2 && stiffness > 400.0) continue;
      CAPTURE(delay, stiffness);
      CHECK(press({}, delay, stiffness).gain == 1.0);
    }
  }
  CHECK(press({}, 10, 2000.0).gain < 1.0);
  // At 4 ms it would shake the hand on.
  CHECK(press({}, 4, 2000.0).gain < 1.0);
  CHECK(lowest_port_energy({}, 4, 2000.0) > -6e-3);
  CHECK(lowest_port_energy(Guards{}.without(Guard::kOscillation), 4, 2000.0) < -10e-3);
}
