#include <array>
#include <cmath>

#include "simulation/step/bridged_stylus.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"

// What the server makes of the forces of a bridge that solves the contact, when the bridge, the
// object or the run changes.

using namespace irdm;

namespace {

constexpr double kCubeHalf = 0.06;
constexpr std::uint64_t kSession = 7;

// A cube on the floor.
SimulationConfig resting() {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = test::fem_cube({.cells = 3, .youngs_modulus = 1e6});
  config.floor = FloorConfig{.height = -kCubeHalf};
  config.gravity = Vector3(0, -9.81, 0);
  config.styluses = {{0.0, 2000.0, 0.0}};
  return config;
}

SimulationConfig cubes(std::size_t count) {
  SimulationConfig config;
  config.objects.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    config.objects[i].model = test::fem_cube({.cells = 3, .youngs_modulus = 2e4});
    config.objects[i].position = Vector3(0.3 * static_cast<double>(i), 0, 0);
    config.objects[i].friction = {0.6, 0.5};
  }
  config.styluses = {{0.0, 2000.0, 0.0}};
  return config;
}

/// A server, and what one bridge tells it.
class Served {
 public:
  explicit Served(std::size_t objects) : Served(cubes(objects)) {}
  explicit Served(const SimulationConfig& config) : simulation(config), bridged(simulation, 0) {}

  /// One step with the tip here; the bridge tells of this force, unless it is held back.
  void step(const Vector3& tip, const Vector3& force, bool told = true, bool reset = false) {
    applied.step = simulation.next_step();
    applied.count = 1;
    applied.base = base.value_or(applied.step);
    applied.past[0] = {force, tip, told_arm.value_or(tip)};
    if (told) history.take(applied);
    const std::array commands{bridged.next({true, 0, tip, {}}, session, history)};
    simulation.step(commands, record, reset);
    bridged.predict_horizon(model);
  }
  void tell_now(std::uint64_t step, const Vector3& tip, const Vector3& force) {
    applied.step = step;
    applied.past[0] = {force, tip, tip};
    history.take(applied);
  }
  void begin_session(std::uint64_t number) {
    session = number;
    history = AppliedHistory(number);
  }
  Vector3 moved(int object) const {
    return record.object[static_cast<std::size_t>(object)].velocity;
  }

  Simulation simulation;
  BridgedStylus bridged;
  std::uint64_t session = kSession;
  AppliedHistory history{kSession};
  AppliedForces applied;
  std::optional<std::uint64_t> base;  ///< that the bridge tells of; none: the newest
  std::optional<Vector3> told_arm;    ///< none: where the tip is
  StepRecord record;
  ContactModel model;
};

const Vector3 kAbove(0.005, kCubeHalf + 0.001, 0.005);
const Vector3 kPush(0, -0.2, 0);

}  // namespace

TEST_CASE("bridged stylus: its force acts on the object that the model spoke of, and on no other") {
  Served served(2);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  for (int k = 0; k < 5; ++k) served.step(kAbove, kPush);
  CHECK(served.moved(0).y() < -1e-4);
  CHECK(served.moved(1).isZero(0.0));
  CHECK((served.record.stylus[0].force + kPush).norm() < 1e-12);
}

// The lever arm that the bridge tells is what acts, and what a trace says.
TEST_CASE("bridged stylus: its force turns the object by the arm that the bridge tells") {
  Served served(1);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  served.told_arm = kAbove + Vector3(0.004, -0.002, 0.003);
  served.step(kAbove, kPush);
  const ObjectRecord& object = served.record.object[0];
  const ContactRecord& contact = object.contact[0];
  REQUIRE(contact.state == ContactState::kTouching);
  const Model& model = *cubes(1).objects[0].model;
  const Vector3 moment = served.simulation.dt() * served.told_arm->cross(kPush);
  const Vector3 turned = model.body.inertia * object.angular_velocity;
  // But for the gyroscopic moment of what it has begun to turn.
  const double gyroscopic = served.simulation.dt() * object.angular_velocity.norm();
  CHECK((turned - moment).norm() < gyroscopic * moment.norm());
  // Nothing has deformed it yet.
  Vector3 point = Vector3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    point += contact.point.weights[i] * model.mesh.rest_position(contact.point.nodes[i]);
  }
  CHECK((point + contact.offset - *served.told_arm).norm() < 1e-12);
}

TEST_CASE("bridged stylus: an arm that is nowhere near the object is not believed") {
  Served served(1);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  served.told_arm = Vector3(3.0, 0, 0);
  served.step(kAbove, kPush);
  const ContactRecord& contact = served.record.object[0].contact[0];
  REQUIRE(contact.state == ContactState::kTouching);
  CHECK(contact.offset.norm() < 0.01);
}

TEST_CASE("bridged stylus: a force from far away acts on nothing") {
  Served served(1);
  for (int k = 0; k < 5; ++k) served.step(Vector3(0, 0.2, 0), Vector3::Zero());
  for (int k = 0; k < 5; ++k) served.step(Vector3(0, 0.2, 0), kPush);
  CHECK(served.moved(0).isZero(0.0));
}

TEST_CASE("bridged stylus: a new session knows nothing of the one before") {
  Served served(1);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  served.begin_session(kSession + 1);
  // The next hand is on the other side: no way leads through the object.
  const Vector3 below(0.005, -kCubeHalf - 0.001, 0.005);
  for (int k = 0; k < 20; ++k) {
    served.step(below, Vector3::Zero());
    CHECK(served.record.stylus[0].contact == ContactState::kFree);
    if (k > 2) CHECK(served.model.normal.y() < -0.9);
  }
  CHECK(served.moved(0).isZero(1e-12));
}

TEST_CASE("bridged stylus: numbers of steps that no bridge counts harm its own session only") {
  Served served(1);
  served.tell_now(std::uint64_t{1} << 60, kAbove, kPush);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero(), false);
  served.begin_session(kSession + 1);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  for (int k = 0; k < 5; ++k) served.step(kAbove, kPush);
  CHECK(served.moved(0).y() < -1e-4);
}

TEST_CASE(
    "bridged stylus: the late force of a new touch acts where the tip was, not where it touched "
    "last") {
  Served served(1);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  for (int k = 0; k < 5; ++k) served.step(kAbove, kPush);
  const Vector3 right(kCubeHalf + 0.001, 0.005, 0.005);
  for (int k = 0; k < 10; ++k) served.step(Vector3(0.1, 0.1, 0), Vector3::Zero());
  for (int k = 0; k < 10; ++k) served.step(right, Vector3::Zero());
  served.step(right, Vector3::Zero(), false);
  const std::uint64_t missed = served.simulation.next_step() - 1;
  served.tell_now(missed, right, Vector3(-0.2, 0, 0));
  served.step(right, Vector3::Zero());
  CHECK(served.bridged.late() == 1);
  REQUIRE(served.record.late.count == 1);
  const LateForce& late = served.record.late.force[0];
  CHECK(late.arm.x() > 0.9 * kCubeHalf);
  CHECK(late.age == 0);
}

TEST_CASE("bridged stylus: what rests on a model from before a reset is for another object") {
  Served served(1);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  served.base = served.simulation.next_step() - 1;
  served.step(kAbove, kPush, true, true);  // reset before this step
  for (int k = 0; k < 5; ++k) served.step(kAbove, kPush);
  CHECK(served.moved(0).isZero(0.0));
  served.base.reset();
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  for (int k = 0; k < 5; ++k) served.step(kAbove, kPush);
  CHECK(served.moved(0).y() < -1e-4);
}

// A message repeats the steps before its newest; they may rest on a model from before the reset,
// and be for steps that are still to come.
TEST_CASE("bridged stylus: of the first message after a reset the newest force alone counts") {
  Served served(1);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  served.step(kAbove, Vector3::Zero(), false, true);  // reset before this step
  served.applied.step = served.simulation.next_step() + 3;
  served.applied.base = served.simulation.next_step() - 1;
  served.applied.count = 4;
  served.applied.past.fill({kPush, kAbove, kAbove});
  served.history.take(served.applied);
  for (int k = 0; k < 3; ++k) {
    served.step(kAbove, Vector3::Zero(), false);
    CHECK(served.moved(0).isZero(0.0));
  }
  served.step(kAbove, Vector3::Zero(), false);
  CHECK(served.moved(0).y() < -1e-4);
}

TEST_CASE("bridged stylus: a force is bounded, and one that is never told of is lost") {
  constexpr double kMost = 5.0;
  SimulationConfig config = cubes(1);
  config.styluses[0].max_force = kMost;
  Served served(config);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  served.step(kAbove, 500.0 * kPush.normalized());
  CHECK(served.bridged.bounded() == 1);
  CHECK(served.record.stylus[0].force.norm() == Approx(kMost));
  Served silent(1);
  for (int k = 0; k < 5; ++k) silent.step(kAbove, Vector3::Zero());
  silent.step(kAbove, Vector3::Zero(), false);
  for (std::uint64_t i = 1; i < BridgedStylus::kFarModelPeriod; ++i)
    silent.step(kAbove, Vector3::Zero());
  const std::uint64_t after = silent.model.step - 5;  // of the one that was not told
  REQUIRE(after < BridgedStylus::kFarModelPeriod);
  CHECK(silent.model.missing == std::uint64_t{1} << after);
  for (int k = 0; k < 60; ++k) silent.step(kAbove, Vector3::Zero());
  CHECK(silent.bridged.lost() == 1);
  CHECK(silent.model.missing == 0);
}

// Two bridges push on a body that stays where it is: what the contact model of each says of the
// other.
TEST_CASE("bridged stylus: the other's force is in its contact model as the mean over 0.2 s") {
  SimulationConfig config = cubes(1);
  Model fixed = *config.objects[0].model;
  fixed.body.support = Support::kFixed;
  config.objects[0].model = std::make_shared<const Model>(fixed);
  config.styluses.resize(2, config.styluses[0]);
  Simulation simulation(config);
  const std::array tips{Vector3(kCubeHalf + 5e-4, 0.01, 0.01), Vector3(-kCubeHalf - 5e-4, 0, 0.02)};
  const std::array forces{Vector3(-0.03, 0.004, 0), Vector3(0.02, 0, -0.003)};
  StepRecord record;
  ContactModel model;
  constexpr int kSteps = 60;
  for (int k = -1; k < kSteps; ++k) {
    std::array<StylusCommand, 2> commands;
    for (std::size_t s = 0; s < 2; ++s) {
      commands[s] = {true, 0, tips[s], {}};
      commands[s].bridged = BridgedForce{k < 0 ? Vector3::Zero() : forces[s], tips[s], 0};
    }
    simulation.step(commands, record);
  }
  const double settled = 1.0 - std::pow(1.0 - simulation.dt() / 0.2, kSteps);
  for (std::size_t s = 0; s < 2; ++s) {
    const std::size_t other = 1 - s;
    simulation.predict_horizon(s, tips[s], 10, model);
    REQUIRE(model.valid);
    const Vector3 expected = settled * forces[other];
    CHECK((model.other_force - expected).norm() < 1e-12);
    CHECK((model.other_torque - tips[other].cross(expected)).norm() < 1e-12);
  }
}

TEST_CASE("bridged stylus: the horizon covers the bridge's lead and an overrun, longer at once") {
  constexpr double kStep = 0.001;
  HorizonLength horizon(kStep);
  CHECK(horizon.steps() == 50);
  const auto told = [](std::uint64_t newest, std::uint64_t base) {
    AppliedHistory history(1);
    history.take({.step = newest, .base = base, .count = 1, .past = {}});
    return history;
  };
  for (int k = 0; k < 999; ++k) horizon.follow(told(103, 100));
  CHECK(horizon.steps() == 50);
  horizon.follow(told(103, 100));
  CHECK(horizon.steps() == 24);
  CHECK(horizon.lead() == 3);
  horizon.follow(told(111, 100));
  CHECK(horizon.steps() == 32);
  horizon.follow(told(190, 100));
  CHECK(horizon.steps() == 50);
  CHECK(horizon.lead() == kMaxHorizon);
}

TEST_CASE("bridged stylus: late forces that press an object on the floor do not throw it") {
  Served served(resting());
  const Vector3 push(0, -3.0, 0);
  for (int k = 0; k < 20; ++k) served.step(kAbove, Vector3::Zero());
  for (int k = 0; k < 50; ++k) served.step(kAbove, push);
  for (int k = 0; k < 8; ++k) served.step(kAbove, push, false);
  const std::uint64_t now = served.simulation.next_step();
  for (std::uint64_t age = 8; age > 0; --age) served.tell_now(now - age, kAbove, push);
  double fastest = 0.0;
  for (int k = 0; k < 50; ++k) {
    served.step(kAbove, push);
    fastest = std::max(fastest, served.moved(0).norm());
  }
  CHECK(served.bridged.late() == 8);
  CHECK(fastest < 0.02);
}

TEST_CASE("bridged stylus: a force whose tip is not where its samples are exerts nothing") {
  Served served(1);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  served.applied.step = served.simulation.next_step();
  served.applied.past[0] = {kPush, kAbove + Vector3(0, 1.0, 0), kAbove};
  served.history.take(served.applied);
  served.step(kAbove, kPush, false);
  CHECK(served.bridged.disagreed() == 1);
  CHECK(served.moved(0).isZero(0.0));
  served.step(kAbove, kPush);
  CHECK(served.bridged.disagreed() == 1);
  CHECK(served.moved(0).y() < -1e-5);
}

// At rest, a push of 40 N for a step gives the cube 17 mJ; its hand has done nothing.
TEST_CASE("bridged stylus: a force puts in no more than 10 mJ beyond what hands did") {
  Served served(1);
  for (int k = 0; k < 5; ++k) served.step(kAbove, Vector3::Zero());
  for (int k = 0; k < 5; ++k) {
    served.step(kAbove, kMostAppliedForce * kPush.normalized());
    const double energy = served.simulation.object(0).energy();
    CHECK(energy > 0.004);
    CHECK(energy < 0.0105);
  }
}
