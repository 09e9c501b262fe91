#include <cmath>
#include <random>

#include "common/motion/rigid_body.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

BodyProperties brick() {
  BodyProperties body;
  body.mass = 0.2;
  body.inertia = Vector3(3e-4, 5e-4, 7e-4).asDiagonal();
  return body;
}

double rotational_energy(const RigidBody& body, const RigidState& state) {
  return 0.5 * state.angular_momentum.dot(body.angular_velocity(state));
}

}  // namespace

TEST_CASE("rigid body: momentum and angular momentum change exactly by the impulses applied") {
  constexpr double kDt = 0.002;
  const RigidBody body(brick(), kDt);
  RigidState state;
  state.angular_momentum = Vector3(1e-3, 2e-3, -1e-3);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vector3(uniform(random), uniform(random), uniform(random)); };
  Vector3 momentum = Vector3::Zero();
  Vector3 angular = state.angular_momentum;
  double scale = 0.0;
  for (int k = 0; k < 10'000; ++k) {
    const Vector3 force = vector();
    const Vector3 torque = 0.01 * vector();
    state = body.advance(state, force, torque);
    momentum += kDt * force;
    angular += kDt * torque;
    scale += kDt * force.norm();
  }
  CHECK((body.mass() * state.velocity - momentum).norm() < 1e-10 * scale);
  CHECK((state.angular_momentum - angular).norm() < 1e-10 * angular.norm());
}

TEST_CASE("rigid body: a free spin keeps its angular momentum, and its energy does not drift") {
  const RigidBody body(brick(), 0.002);
  RigidState state;
  // About the middle axis, slightly off: the motion that tumbles.
  state.angular_momentum = body.angular_momentum(state.orientation, Vector3(0.1, 12.0, 0.1));
  const RigidState start = state;
  const double energy = rotational_energy(body, state);
  double largest = 0.0;
  double turned = 0.0;
  for (int k = 0; k < 10'000; ++k) {
    state = body.advance(state, Vector3::Zero(), Vector3::Zero());
    largest = std::max(largest, std::abs(rotational_energy(body, state) / energy - 1.0));
    turned = std::max(turned, state.orientation.angularDistance(start.orientation));
  }
  CHECK(state.angular_momentum == start.angular_momentum);
  CHECK(largest < 1e-3);
  CHECK(turned > 3.0);
  CHECK(std::abs(state.orientation.norm() - 1.0) < 1e-12);
}

TEST_CASE(
    "rigid body: under held forces its centre moves as the equations say, whatever the step") {
  const auto place = [](double dt) {
    const RigidBody body(brick(), dt);
    RigidState state;
    state.velocity = Vector3(0.1, 0.2, -0.1);
    for (int k = 0; k < std::lround(0.8 / dt); ++k) {
      const double t = (k + 0.5) * dt;
      state = body.advance(state, t < 0.4 ? Vector3(1.0, -2.0, 0.5) : Vector3(-0.3, 0.0, 1.0),
                           Vector3::Zero());
    }
    return state.position;
  };
  const Vector3 first = Vector3(1.0, -2.0, 0.5) / brick().mass;
  const Vector3 then = Vector3(-0.3, 0.0, 1.0) / brick().mass;
  const Vector3 expected =
      0.8 * Vector3(0.1, 0.2, -0.1) + 0.5 * 0.16 * first + 0.4 * 0.4 * first + 0.5 * 0.16 * then;
  for (const double dt : {0.001, 0.002, 0.004, 0.02}) {
    CHECK((place(dt) - expected).norm() < 1e-12);
  }
}

TEST_CASE("rigid body: a torque that is fixed in space turns it with second order in the step") {
  const auto final_state = [](double dt) {
    const RigidBody body(brick(), dt);
    RigidState state;
    state.angular_momentum = body.angular_momentum(state.orientation, Vector3(1.0, 3.0, 2.0));
    for (int k = 0; k < std::lround(0.512 / dt); ++k) {
      state = body.advance(state, Vector3::Zero(), Vector3(2e-3, -1e-3, 3e-3));
    }
    return state.orientation;
  };
  const Quaternion reference = final_state(0.004 / 256);
  const double coarse = final_state(0.004).angularDistance(reference);
  const double fine = final_state(0.002).angularDistance(reference);
  CHECK(coarse < 1e-3);
  CHECK(coarse / fine == Approx(4.0).epsilon(0.1));
}

TEST_CASE("rigid body: the rotation is second order in the step") {
  // Against the same spin with a step 256 times finer.
  const auto final_orientation = [](double dt) {
    const RigidBody body(brick(), dt);
    RigidState state;
    state.angular_momentum = body.angular_momentum(state.orientation, Vector3(4.0, 9.0, 3.0));
    for (int k = 0; k < static_cast<int>(std::lround(0.512 / dt)); ++k) {
      state = body.advance(state, Vector3::Zero(), Vector3::Zero());
    }
    return state.orientation;
  };
  const Quaternion reference = final_orientation(0.004 / 256);
  const double coarse = final_orientation(0.004).angularDistance(reference);
  const double fine = final_orientation(0.002).angularDistance(reference);
  CHECK(coarse / fine == Approx(4.0).epsilon(0.1));
}

TEST_CASE("rigid body: compliance is what a force held during one step does") {
  constexpr double kDt = 0.001;
  const RigidBody body(brick(), kDt);
  const Vector3 from(0.05, -0.02, 0.03);
  const Vector3 at(-0.04, 0.06, 0.01);
  const Vector3 force(1e-4, -2e-4, 3e-4);  // small: the compliance is the linear part
  const RigidState state = body.advance(RigidState{}, force, from.cross(force));
  const Vector3 moved = state.position + state.orientation * at - at;
  CHECK((moved - body.mobility().between(at, from) * force).norm() < 1e-6 * moved.norm());
  CHECK((body.mobility().between(at, from) - body.mobility().between(from, at).transpose()).norm() <
        1e-18);
}

TEST_CASE("rigid body: a fixed object does not move") {
  BodyProperties properties = brick();
  properties.support = Support::kFixed;
  const RigidBody body(properties, 0.002);
  const RigidState state = body.advance(RigidState{}, Vector3(1, 2, 3), Vector3(1, 2, 3));
  CHECK(state.position == Vector3::Zero());
  CHECK(state.orientation.coeffs() == Quaternion::Identity().coeffs());
  CHECK(body.mobility().between(Vector3(1, 0, 0), Vector3(0, 1, 0)).norm() == 0.0);
}

TEST_CASE("rotation by a vector equals the rotation by its angle about its axis, small ones too") {
  for (const double angle : {0.0, 1e-12, 1e-5, 1e-4, 0.3, 3.0}) {
    const Vector3 axis = Vector3(1, -2, 0.5).normalized();
    const Quaternion expected(Eigen::AngleAxisd(angle, axis));
    CHECK((rotation_from_vector(angle * axis).coeffs() - expected.coeffs()).norm() < 1e-15);
  }
}
