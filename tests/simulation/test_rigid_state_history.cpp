#include <random>
#include <vector>

#include "common/motion/free_motion.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

namespace {

constexpr double kDt = 0.002;

RigidBody brick_body() {
  BodyProperties properties;
  properties.mass = 0.2;
  properties.inertia = Vector3(3e-4, 5e-4, 7e-4).asDiagonal();
  return {properties, kDt};
}

FreeForces tethered_body() {
  FreeForces free;
  free.gravity = Vector3(0, -9.81, 0);
  free.damping = {1.0, 2.0};
  free.tether = {50.0, 0.1};
  return free;
}

struct Push {
  Vector3 force;  ///< W
  Vector3 arm;    ///< B
};

/// A body that is pushed at two places in each step.
class Pushed {
 public:
  explicit Pushed(std::size_t steps) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto vector = [&] { return Vector3(uniform(random), uniform(random), uniform(random)); };
    for (std::size_t k = 0; k < 2 * steps; ++k) pushes.push_back({vector(), 0.05 * vector()});
    state.velocity = Vector3(0.2, 0, -0.1);
    state.angular_momentum = Vector3(2e-3, -3e-3, 1e-3);
  }

  void step(bool with_second) {
    const std::size_t k = count++;
    RigidStateHistory::Forces forces;
    forces.add(pushes[2 * k].force, pushes[2 * k].arm);
    if (with_second) forces.add(pushes[2 * k + 1].force, pushes[2 * k + 1].arm);
    const FreeMotion motion = free_motion(body, free, state);
    const Quaternion halfway = body.mid_step_orientation(state);
    past.remember(state, halfway, forces);
    state = end_of_step(body, free, motion, forces.sum, forces.torque(halfway));
  }
  /// The second push of a step, now.
  void enter(int age) {
    const Push& push = pushes[2 * (count - 1 - static_cast<std::size_t>(age)) + 1];
    past.add(age, push.force, push.arm);
  }
  void replay() { state = past.replay(body, free, state); }

  RigidBody body = brick_body();
  FreeForces free = tethered_body();
  std::vector<Push> pushes;
  std::size_t count = 0;
  RigidState state;
  RigidStateHistory past;
};

double difference(const RigidState& a, const RigidState& b) {
  return (a.position - b.position).norm() + a.orientation.angularDistance(b.orientation) +
         (a.velocity - b.velocity).norm() + (a.angular_momentum - b.angular_momentum).norm();
}

}  // namespace

TEST_CASE("rigid past: the torque of forces is that of each about the centre of mass") {
  RigidStateHistory::Forces forces;
  const Quaternion Q = rotation_from_vector(Vector3(0.3, -1.0, 0.5));
  Vector3 torque = Vector3::Zero();
  for (const Push& push : Pushed(5).pushes) {
    forces.add(push.force, push.arm);
    torque += (Q * push.arm).cross(push.force);
  }
  CHECK((forces.torque(Q) - torque).norm() < 1e-15);
}

TEST_CASE(
    "rigid past: whatever comes late, in any order, the body ends as if all had been on time") {
  Pushed direct(200);
  Pushed late(200);
  for (int k = 0; k < 200; ++k) {
    direct.step(true);
    late.step(k % 20 < 5);
    if (k % 20 != 19) continue;
    // The others of the last twenty steps: some now, some after those have taken their effect.
    for (int age = 0; age < 15; age += 2) late.enter(age);
    CHECK(late.past.changed());
    late.replay();
    CHECK_FALSE(late.past.changed());
    CHECK(difference(direct.state, late.state) > 1e-3);
    for (int age = 13; age > 0; age -= 2) late.enter(age);
    late.replay();
    CHECK(difference(direct.state, late.state) < 1e-12);
  }
}

TEST_CASE("rigid past: the oldest step that it knows is kKept steps back, and none after clear") {
  Pushed direct(100);
  Pushed late(100);
  CHECK(late.past.count() == 0);
  for (int k = 0; k < 100; ++k) {
    direct.step(true);
    late.step(k != 100 - RigidStateHistory::kKept);
  }
  CHECK(late.past.count() == RigidStateHistory::kKept);
  CHECK(difference(direct.state, late.state) > 1e-3);
  late.enter(RigidStateHistory::kKept - 1);
  late.replay();
  CHECK(difference(direct.state, late.state) < 1e-12);
  late.enter(0);
  late.past.clear();
  CHECK(late.past.count() == 0);
  CHECK(difference(late.past.replay(late.body, late.free, direct.state), direct.state) == 0.0);
}
