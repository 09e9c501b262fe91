#include <cmath>

#include "device_bridge/virtual_stylus.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

TEST_CASE("motors without limits show what they are given, for ever and cold") {
  VirtualMotors motors({});
  motors.set({Vector3(0, 50, 0)});
  motors.advance(1e6);
  CHECK(motors.shown().force == Vector3(0, 50, 0));
  CHECK(motors.on_for(1e6) == 1e6);
  CHECK(motors.warmth() == 0.0);
}

TEST_CASE("motors shorten a force that is too long, and show none that is not finite") {
  VirtualMotors motors({.max_force = 2.0});
  motors.set({Vector3(3, 0, -4)});
  CHECK(motors.shown().force.isApprox(Vector3(1.2, 0, -1.6)));
  motors.set({Vector3(0, 1, 0)});
  CHECK(motors.shown().force == Vector3(0, 1, 0));
  motors.set({Vector3(0, std::nan(""), 0)});
  CHECK(motors.shown().force.isZero(0.0));
}

TEST_CASE("motors go off when no force comes for as long as their watchdog waits") {
  VirtualMotors motors({.watchdog = 0.032});
  motors.set({Vector3(0, 1, 0)});
  CHECK(motors.on_for(0.01) == 0.01);
  CHECK(motors.on_for(1.0) == Approx(0.032));
  motors.advance(0.03);
  CHECK(motors.on_for(0.01) == Approx(0.002));
  motors.advance(0.01);
  CHECK(motors.on_for(0.01) == 0.0);
  CHECK(motors.off());
  motors.set({Vector3(0, 1, 0)});
  CHECK(motors.on_for(0.01) == 0.01);
  CHECK_FALSE(motors.off());
}

TEST_CASE("motors warm up with the square of the force, and cool down") {
  const MotorParameters parameters{.continuous_force = 0.5, .time_constant = 10.0};
  VirtualMotors motors(parameters);
  for (int i = 0; i < 1000; ++i) {
    motors.set({Vector3(0, 1, 0)});  // twice what they bear: four times as warm in the end
    motors.advance(0.01);
  }
  CHECK(motors.warmth() == Approx(4.0 * (1.0 - std::exp(-1.0))));
  const double warm = motors.warmth();
  motors.set({Vector3::Zero()});
  motors.advance(10.0);
  CHECK(motors.warmth() == Approx(warm * std::exp(-1.0)));
  motors.set({Vector3(0, 0.5, 0)});
  motors.advance(1000.0);
  CHECK(motors.warmth() == Approx(1.0));
}

TEST_CASE("motors that the watchdog took off do not warm up") {
  VirtualMotors motors({.continuous_force = 1.0, .time_constant = 1.0, .watchdog = 0.5});
  motors.set({Vector3(0, 1, 0)});
  motors.advance(0.5);
  const double warm = motors.warmth();
  CHECK(warm > 0.3);
  motors.advance(1.0);
  CHECK(motors.warmth() == Approx(warm * std::exp(-1.0)));
}
