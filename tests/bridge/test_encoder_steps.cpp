// Velocity and damping of a device whose position comes in steps.
#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include "device_bridge/bridge.hpp"
#include "device_bridge/safety/velocity_estimate.hpp"
#include "device_bridge/virtual_stylus.hpp"
#include "tests/bridge/filter_rig.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using test::FilterRig;
using test::kMs;

namespace {

constexpr double kStep = 5.5e-5;  // a Touch's [m]

double counted(double x) {
  return kStep * std::round(x / kStep);
}

/// Position of a hand at rest as encoders at the edge of a count tell it.
class RestingTip {
 public:
  Vector3 next() {
    std::uniform_int_distribution<int> count(0, 1);
    const auto axis = [&] { return kStep * count(random_); };
    return {axis(), axis(), axis()};
  }

 private:
  std::mt19937 random_{1};
};

// The smallest force on a resting hand within a minute, of one that stays as it is asked for and
// is two milliseconds old [N].
double least_force(double resolution, double asked) {
  FilterLimits limits;
  limits.reading.resolution = resolution;
  FilterRig rig({}, limits);
  RestingTip hand;
  double least = asked;
  for (int tick = 0; tick < 60'000; ++tick) {
    rig.tip = hand.next();
    rig.demand_now(asked * Vector3(1, 2, 2) / 3.0);
    rig.demand.normal = rig.demand.force.normalized();
    rig.demand.sample_time_ns -= 2 * kMs;
    rig.tick();
    if (tick > 1000) least = std::min(least, rig.shown.norm());
  }
  return least;
}

}  // namespace

TEST_CASE("encoder steps: a resting hand has no velocity, whatever way its readings go") {
  VelocityEstimate estimate(kStep);
  RestingTip hand;
  double fastest = 0.0;
  for (int tick = 0; tick < 1000; ++tick) {
    const double speed = estimate.next(tick * kMs, hand.next()).norm();
    if (tick > 100) fastest = std::max(fastest, speed);  // it has found the middle
  }
  CHECK(fastest == 0.0);
}

TEST_CASE("encoder steps: a steady velocity is told from counts, slow or fast") {
  const double speed = GENERATE(0.008, 0.03, 0.1, 0.5);
  const double way = GENERATE(1.0, -1.0);
  CAPTURE(speed, way);
  VelocityEstimate estimate(kStep);
  double error = 0.0;
  double sum = 0.0;
  constexpr int kTicks = 500;
  for (int tick = 0; tick < kTicks; ++tick) {
    const double x = way * speed * 1e-3 * tick;
    const Vector3 v = estimate.next(tick * kMs, {counted(x), 0.2, -x});
    if (tick < 50) continue;
    error = std::max(error, std::abs(v.x() - way * speed));
    sum += v.x();
  }
  // Two steps over the time of the longest line.
  CHECK(error <= 2.0 * kStep / (1e-3 * VelocityEstimate::kLongest));
  CHECK(sum / (kTicks - 50) == Approx(way * speed).epsilon(0.03));
}

TEST_CASE("encoder steps: a hand that stops is told at once, and one that turns round soon") {
  VelocityEstimate estimate(kStep);
  double x = 0.0;
  int tick = 0;
  const auto move = [&](double speed, int ticks) {
    Vector3 v = Vector3::Zero();
    for (int i = 0; i < ticks; ++i) {
      x += 1e-3 * speed;
      v = estimate.next(++tick * kMs, {counted(x), 0, 0});
    }
    return v.x();
  };
  CHECK(move(0.3, 100) == Approx(0.3).epsilon(0.05));
  CHECK(std::abs(move(0.0, 2)) < 0.1);
  CHECK(std::abs(move(0.0, 20)) < 1e-9);
  move(0.3, 100);
  CHECK(move(-0.3, 3) < -0.15);
}

TEST_CASE("encoder steps: without a resolution it is the difference of two readings") {
  VelocityEstimate estimate(0.0);
  CHECK(estimate.next(5 * kMs, {1.0, 0, 0}).isZero(0.0));
  CHECK(estimate.next(7 * kMs, {1.5, 0, 0}).x() == 0.5 / 2e-3);
  CHECK(estimate.next(8 * kMs, {1.5, 0.25, 0}) == Vector3(0, 0.25 / 1e-3, 0));
}

TEST_CASE("encoder steps: a force on a resting hand stays what it is") {
  CHECK(least_force(kStep, 0.2) == Approx(0.2).epsilon(1e-9));
  CHECK(least_force(0.0, 0.2) < 0.15);  // damping by noise looks like energy given
}

TEST_CASE("encoder steps: a device's resolution, or that of its noise, is the filter's") {
  std::istringstream script("time,x,y,z\n0,0,0,0\n");
  const VirtualStylus coarse(StylusScript::parse(script, "script"), {}, {.resolution = kStep});
  CHECK(filter_limits(coarse, {}).reading.resolution == kStep);
  script = std::istringstream("time,x,y,z\n0,0,0,0\n");
  const VirtualStylus noisy(StylusScript::parse(script, "script"), {},
                            {.resolution = kStep, .noise = kStep});
  CHECK(filter_limits(noisy, {}).reading.resolution == kNoiseSteps * kStep);
}
