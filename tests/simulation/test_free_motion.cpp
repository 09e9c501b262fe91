// Gravity, damping and tether of a body that nothing touches, against closed forms.
#include <cmath>
#include <numbers>

#include "common/motion/free_motion.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

BodyProperties ball() {
  BodyProperties body;
  body.mass = 0.2;
  body.inertia = 4e-4 * Matrix3::Identity();
  return body;
}

RigidState after(double seconds, double dt, const FreeForces& forces, RigidState state) {
  const RigidBody body(ball(), dt);
  for (int k = 0; k < std::lround(seconds / dt); ++k) {
    state = end_of_step(body, forces, free_motion(body, forces, state), Vector3::Zero(),
                        Vector3::Zero());
  }
  return state;
}

}  // namespace

TEST_CASE("free motion: a fall that is damped, second order in the step") {
  FreeForces forces;
  forces.gravity = Vector3(0, -9.81, 0);
  forces.damping = {10.0, 0.0};
  // v = g / c (1 - exp(-c t)), y = g / c (t - (1 - exp(-c t)) / c)
  const double decayed = 1.0 - std::exp(-10.0 * 0.4);
  const double velocity = -0.981 * decayed;
  const double place = -0.981 * (0.4 - 0.1 * decayed);
  const auto error = [&](double dt) {
    const RigidState end = after(0.4, dt, forces, {});
    return std::abs(end.velocity.y() - velocity) + std::abs(end.position.y() - place);
  };
  CHECK(error(0.002) < 1e-4);
  CHECK(error(0.004) / error(0.002) == Approx(4.0).epsilon(0.05));
}

TEST_CASE("free motion: damping without forces is exact") {
  FreeForces forces;
  forces.damping = {3.0, 7.0};
  RigidState start;
  start.velocity = Vector3(1, -2, 0.5);
  start.angular_momentum = Vector3(1e-3, 2e-3, -1e-3);
  const RigidState end = after(0.5, 0.002, forces, start);
  CHECK((end.velocity - std::exp(-1.5) * start.velocity).norm() < 1e-14);
  CHECK((end.angular_momentum - std::exp(-3.5) * start.angular_momentum).norm() < 1e-17);
}

TEST_CASE("free motion: a tether swings with its frequency, second order, and keeps its energy") {
  FreeForces forces;
  forces.tether = {20.0, 0.04};
  const double rate = std::sqrt(20.0 / 0.2);
  RigidState start;
  start.position = Vector3(0.01, 0.0, -0.02);
  start.orientation = rotation_from_vector(Vector3(0.0, 0.2, 0.0));
  const auto error = [&](double dt) {
    const RigidState end = after(2.0, dt, forces, start);
    const double turned = 0.2 * std::cos(rate * 2.0);  // sqrt(0.04 / 4e-4) is the same rate
    return (end.position - std::cos(rate * 2.0) * start.position).norm() / 0.02 +
           end.orientation.angularDistance(rotation_from_vector(Vector3(0.0, turned, 0.0))) / 0.2;
  };
  CHECK(error(0.002) < 2e-3);
  CHECK(error(0.004) / error(0.002) == Approx(4.0).epsilon(0.1));
  // A hundred thousand steps later it swings as far.
  const RigidBody body(ball(), 0.002);
  RigidState state = start;
  double farthest = 0.0;
  for (int k = 0; k < 100'000; ++k) {
    state = end_of_step(body, forces, free_motion(body, forces, state), Vector3::Zero(),
                        Vector3::Zero());
    if (k > 99'000) farthest = std::max(farthest, state.position.norm());
  }
  CHECK(farthest == Approx(start.position.norm()).epsilon(1e-3));
}

TEST_CASE("free motion: a tether turns the short way, whichever sign the quaternion has") {
  FreeForces forces;
  forces.tether = {0.0, 0.04};
  forces.home_orientation = rotation_from_vector(Vector3(0.3, -0.2, 0.5));
  const Vector3 axis = Vector3(1.0, 2.0, -2.0) / 3.0;
  const auto degrees = [](double angle) { return angle * std::numbers::pi / 180.0; };
  for (const double turned : {1.0, 90.0, 170.0, 190.0, 200.0, 350.0}) {
    CAPTURE(turned);
    const Quaternion q = rotation_from_vector(degrees(turned) * axis) * forces.home_orientation;
    // Back by `turned`, or on by what is missing to a whole turn.
    const double back = turned < 180.0 ? turned : turned - 360.0;
    const Vector3 expected = -0.04 * degrees(back) * axis;
    CHECK((free_torque(forces, q) - expected).norm() < 1e-14);
    CHECK((free_torque(forces, Quaternion(-q.coeffs())) - expected).norm() < 1e-14);
  }
  CHECK(free_torque(forces, Quaternion(-forces.home_orientation.coeffs())).norm() < 1e-15);
}
