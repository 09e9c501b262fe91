// What the safety filter makes of motors that show less than it sends.
#include <algorithm>
#include <cmath>

#include "common/motion/rigid_body.hpp"
#include "tests/bridge/filter_rig.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using test::FilterRig;
using test::kMs;
using test::kOneUp;

namespace {

constexpr double kWallStiffness = 400.0;  // [N/m]

// The force is shown as it is asked for, so that what is said of the motors changes the accounts
// only.
Guards with_accounts_only() {
  return Guards{}.without(Guard::kPassivity).without(Guard::kOscillation);
}

/// A hand that goes in and out of a wall at a device whose motors give up to `motors` [N].
class SaturatedMotors {
 public:
  SaturatedMotors(Guards guards, double motors, bool tells)
      : rig_(guards, {.max_force = 3.3}), motors_(motors), tells_(tells) {
    rig_.demand.contact = ContactState::kHeld;
  }
  void tick(int i) {
    const Vector3 before = rig_.tip;
    rig_.tip = Vector3(0, -0.006 * std::sin(2e-3 * M_PI * i), 0);
    energy_ = std::clamp(energy_ - really_shown().dot(rig_.tip - before), least_, most_);
    rig_.saturated = tells_ && rig_.shown.norm() > motors_;
    ever_saturated_ = ever_saturated_ || rig_.saturated;
    rig_.demand_now(Vector3(0, std::max(0.0, -kWallStiffness * rig_.tip.y()), 0));
    rig_.tick();
  }
  /// As the passivity observer would have it, of what the motors showed [J].
  double energy() const { return energy_; }
  double observed() const { return rig_.filter.port_energy(); }
  bool ever_saturated() const { return ever_saturated_; }

 private:
  Vector3 really_shown() const {
    const double asked = rig_.shown.norm();
    return asked > motors_ ? Vector3(motors_ / asked * rig_.shown) : rig_.shown;
  }

  FilterRig rig_;
  double motors_;
  bool tells_;
  double least_ = PassivityLimits{}.least;
  double most_ = PassivityLimits{}.most;
  double energy_ = 0.0;
  bool ever_saturated_ = false;
};

}  // namespace

TEST_CASE("saturated motors: what is observed as taken is never more than they really took") {
  for (const double motors : {0.3, 1.0, 2.0}) {
    CAPTURE(motors);
    SaturatedMotors told(with_accounts_only(), motors, true);
    SaturatedMotors silent(with_accounts_only(), motors, false);
    double excess = 0.0;
    double excess_of_silent = 0.0;
    for (int i = 0; i < 3000; ++i) {
      told.tick(i);
      silent.tick(i);
      excess = std::max(excess, told.observed() - told.energy());
      excess_of_silent = std::max(excess_of_silent, silent.observed() - silent.energy());
    }
    CHECK(told.ever_saturated());
    CHECK(excess < 1e-9);
    CHECK(excess_of_silent > 1e-4);  // it would count what was never taken
  }
}

TEST_CASE("saturated motors: in force and in torque apart, only what was given counts") {
  const double way = GENERATE(1e-4, -1e-4);
  FilterRig rig(with_accounts_only(), {.max_torque = 0.15});
  rig.demand.contact = ContactState::kHeld;
  rig.demand.torque = Vector3(0, 0.05, 0);
  rig.ticks(600, kOneUp);  // the ramp is over
  const double before = rig.filter.port_energy();
  rig.saturated = true;
  rig.tip.y() += way;
  rig.orientation = rotation_from_vector(Vector3(0, -20.0 * way, 0));
  rig.tick();  // with the demand of before: the world gives nothing of its own
  const double given = way > 0.0 ? way : 20.0 * -way * 0.05;
  CHECK(rig.filter.port_energy() == Approx(before - given));
}
