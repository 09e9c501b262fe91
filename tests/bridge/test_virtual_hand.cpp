#include <cmath>
#include <random>

#include "common/motion/rigid_body.hpp"
#include "device_bridge/virtual_stylus.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

TEST_CASE("hand let go swings as the damped oscillator of the textbook") {
  const HandParameters hand{.mass = 0.12, .damping = 2.0, .stiffness = 300.0};
  const Vector3 force(0.6, -1.2, 0.0);
  VirtualHand simulated(hand, Vector3::Zero());
  // Step response: F/k (1 - exp(-zeta w0 t) (cos wd t + zeta/sqrt(1 - zeta^2) sin wd t)).
  const double w0 = std::sqrt(hand.stiffness / hand.mass);
  const double zeta = hand.damping / (2.0 * std::sqrt(hand.stiffness * hand.mass));
  const double root = std::sqrt(1.0 - zeta * zeta);
  for (int tick = 1; tick <= 1000; ++tick) {
    simulated.advance(1e-3, Vector3::Zero(), force);
    const double t = 1e-3 * tick;
    const double shape = 1.0 - std::exp(-zeta * w0 * t) * (std::cos(root * w0 * t) +
                                                           zeta / root * std::sin(root * w0 * t));
    REQUIRE((simulated.position() - shape * force / hand.stiffness).norm() < 1e-12);
  }
}

TEST_CASE("hand with critical and with strong damping settles as the textbook says") {
  const double m = 0.1;
  const double k = 90.0;  // w0 = 30
  const double w0 = 30.0;
  const Vector3 force(0, 0.9, 0);
  const double sag = 0.01;
  VirtualHand critical({m, 2.0 * std::sqrt(k * m), k}, Vector3::Zero());
  VirtualHand strong({m, 10.0, k}, Vector3::Zero());
  const double s1 = -50.0 + std::sqrt(2500.0 - 900.0);  // roots of s^2 + 100 s + 900
  const double s2 = -50.0 - std::sqrt(2500.0 - 900.0);
  for (int tick = 1; tick <= 300; ++tick) {
    critical.advance(1e-3, Vector3::Zero(), force);
    strong.advance(1e-3, Vector3::Zero(), force);
    const double t = 1e-3 * tick;
    REQUIRE(std::abs(critical.position().y() - sag * (1 - (1 + w0 * t) * std::exp(-w0 * t))) <
            1e-10);
    const double expected = sag * (1 + (s2 * std::exp(s1 * t) - s1 * std::exp(s2 * t)) / (s1 - s2));
    REQUIRE(std::abs(strong.position().y() - expected) < 1e-12);
  }
}

TEST_CASE("hand does not depend on how time is cut up") {
  const HandParameters hand;
  VirtualHand fine(hand, Vector3::Zero());
  VirtualHand coarse(hand, Vector3::Zero());
  const Vector3 target(0.05, 0.02, -0.01);
  const Vector3 force(0.3, 0, -0.2);
  constexpr int kPieces = 50;
  for (int i = 1; i <= kPieces; ++i) fine.advance(0.1 / kPieces, target * i / kPieces, force);
  coarse.advance(0.1, target, force);
  CHECK((fine.position() - coarse.position()).norm() < 1e-12);
  CHECK((fine.velocity() - coarse.velocity()).norm() < 1e-10);
}

TEST_CASE("hand rests where spring and force balance, and follows an even motion without lag") {
  const HandParameters hand;
  VirtualHand pressed(hand, Vector3::Zero());
  for (int tick = 0; tick < 5000; ++tick) pressed.advance(1e-3, Vector3::Zero(), Vector3(0, 3, 0));
  CHECK((pressed.position() - Vector3(0, 0.01, 0)).norm() < 1e-12);
  VirtualHand moved(hand, Vector3::Zero());
  Vector3 target = Vector3::Zero();
  for (int tick = 0; tick < 5000; ++tick) {
    target.x() += 1e-4;
    moved.advance(1e-3, target, Vector3::Zero());
  }
  CHECK((moved.position() - target).norm() < 1e-9);
}

TEST_CASE("wrist: turns about one axis are the damped oscillator of the textbook") {
  const TurnParameters turn;
  const Vector3 axis = Vector3(1, -2, 2) / 3.0;
  const double torque = 0.3;
  VirtualWrist simulated(turn, Quaternion::Identity());
  const double w0 = std::sqrt(turn.stiffness / turn.inertia);
  const double zeta = turn.damping / (2.0 * std::sqrt(turn.stiffness * turn.inertia));
  const double root = std::sqrt(1.0 - zeta * zeta);
  for (int tick = 1; tick <= 1000; ++tick) {
    simulated.advance(1e-3, Quaternion::Identity(), torque * axis);
    const double t = 1e-3 * tick;
    const double shape = 1.0 - std::exp(-zeta * w0 * t) * (std::cos(root * w0 * t) +
                                                           zeta / root * std::sin(root * w0 * t));
    REQUIRE(
        (rotation_vector(simulated.orientation()) - shape * torque / turn.stiffness * axis).norm() <
        1e-11);
  }
}

TEST_CASE("wrist: it follows a hand that turns evenly without lag, and rests by the torque") {
  const TurnParameters turn;
  VirtualWrist simulated(turn, Quaternion::Identity());
  const Vector3 rate(0, 0, 2.0);  // [rad/s]
  Quaternion target;
  for (int tick = 1; tick <= 3000; ++tick) {
    target = rotation_from_vector(1e-3 * tick * rate);
    simulated.advance(1e-3, target, Vector3::Zero());
  }
  CHECK(simulated.orientation().angularDistance(target) < 1e-7);
  CHECK((simulated.angular_velocity() - rate).norm() < 1e-6);
  const Vector3 torque(0.1, -0.2, 0.05);
  for (int tick = 1; tick <= 5000; ++tick) simulated.advance(1e-3, target, torque);
  const Vector3 found = rotation_vector(simulated.orientation() * target.conjugate());
  CHECK((found - torque / turn.stiffness).norm() < 1e-9);
}

TEST_CASE("hand stays finite for any parameters and steps") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> exponent(-3.0, 3.0);
  const auto any = [&] { return std::pow(10.0, exponent(random)); };
  for (int run = 0; run < 500; ++run) {
    VirtualHand hand({any(), any() * any(), any() * any()}, Vector3::Zero());
    for (int tick = 0; tick < 100; ++tick) hand.advance(any(), Vector3(1, 0, 0), Vector3(1, 1, 1));
    REQUIRE(hand.position().allFinite());
    REQUIRE(hand.velocity().allFinite());
  }
  VirtualHand still({}, Vector3(1, 2, 3));
  still.advance(0.0, Vector3(9, 9, 9), Vector3::Zero());
  CHECK(still.position() == Vector3(1, 2, 3));
}
