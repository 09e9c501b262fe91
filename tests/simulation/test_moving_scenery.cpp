// Scenery that moves as it is told, and what it does to the bodies on it.
#include <cmath>
#include <numbers>

#include "common/motion/rigid_body.hpp"
#include "tests/simulation/touching_cubes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fixed_box.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kSceneryFriction = 0.4;

// A rigid block on a plane.
SimulationConfig block(double friction = kSceneryFriction) {
  SimulationConfig config = stacked(1, {.cells = 3}, {friction, friction});
  Model model = made_rigid(*config.objects[0].model);
  model.dt = 0.002;
  config.objects[0].model = std::make_shared<const Model>(std::move(model));
  config.objects[0].damping = {};
  return config;
}

Vector3 carried(const StepRecord& record) {
  Vector3 sum = Vector3::Zero();
  for (const BodyContactRecord& contact : record.body_contacts()) sum += contact.force;
  return sum;
}

}  // namespace

TEST_CASE("moving scenery: its pose is that of the formula, without drift") {
  SceneryConfig scenery;
  scenery.shape = BoxShape{Vector3(1, 1, 1)};
  scenery.position = Vector3(1, 2, 3);
  scenery.motion.velocity = Vector3(0.1, 0, 0);
  scenery.motion.angular_velocity = Vector3(0, 0.5, 0);
  scenery.motion.stroke = Vector3(0, 0.2, 0);
  scenery.motion.frequency = 2.0;
  SceneryStep step{scenery};
  Vector3 point(1.3, 2.0, 3.0);  // moves along
  for (int k = 1; k <= 1000; ++k) {
    step.go_on(0.001 * k);
    point = step.carried(point);
  }
  CHECK((step.now.position - Vector3(1.1, 2.0, 3.0)).norm() < 1e-12);
  CHECK(step.now.orientation.isApprox(rotation_from_vector(Vector3(0, 0.5, 0))));
  CHECK((point - Vector3(1.1 + 0.3 * std::cos(0.5), 2.0, 3.0 - 0.3 * std::sin(0.5))).norm() < 1e-9);
  step.go_on(0.0);
  CHECK(step.now.position == scenery.position);
  CHECK(step.carried(point) == point);
}

TEST_CASE("moving scenery: a path leads it straight from waypoint to waypoint") {
  SceneryConfig scenery;
  scenery.shape = SphereShape{0.1};
  scenery.position = Vector3(1, 2, 3);
  scenery.motion.path = {{1.0, Vector3(0, 1, 0)}, {2.0, Vector3(0, 1, 4)}, {4.0, Vector3::Zero()}};
  REQUIRE(scenery.motion.any());
  SceneryStep step{scenery};
  const auto there = [&](double t) -> Vector3 {
    step.go_on(t);
    return step.now.position - scenery.position;
  };
  CHECK((there(0.0) - Vector3(0, 1, 0)).norm() < 1e-15);
  CHECK((there(1.0) - Vector3(0, 1, 0)).norm() < 1e-15);
  CHECK((there(1.25) - Vector3(0, 1, 1)).norm() < 1e-15);
  CHECK((there(2.0) - Vector3(0, 1, 4)).norm() < 1e-15);
  CHECK((there(3.0) - Vector3(0, 0.5, 2)).norm() < 1e-15);
  CHECK((step.carried(Vector3(0, 1, 4)) - Vector3(0, 0.5, 2)).norm() < 1e-15);
  CHECK(there(4.0).norm() < 1e-15);
  CHECK(there(1e9).norm() < 1e-15);
}

TEST_CASE("moving scenery: it is where its path begins from the start, as after a reset") {
  SimulationConfig config = block();
  config.scenery[0].position.y() = 0.01;  // in the block, but for the path
  config.scenery[0].motion.path = {{0.0, Vector3(0, -0.02, 0)}};
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 15; ++k) {
    step_alone(simulation, *record);
    CHECK(record->body_contacts().empty());  // it falls 4.4 mm of 10
  }
}

TEST_CASE("moving scenery: a plane that presses a bar on the ground feels E A d / L", "[slow]") {
  FixedBox bar;
  bar.size = Vector3(0.04, 0.12, 0.04);
  bar.cells = {12, 2, 12};
  bar.poisson_ratio = 0.0;
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fixed_box(bar);
  config.contact_samples = 1000;
  SceneryConfig plane;
  plane.shape = PlaneShape{};
  plane.position = Vector3(0, 0.061, 0);
  plane.orientation = Quaternion(0, 1, 0, 0);  // the free side is below
  plane.motion.path = {{0.0, Vector3::Zero()}, {0.2, Vector3(0, -0.003, 0)}};
  config.scenery = {plane};
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  step_alone(simulation, *record);
  CHECK(record->body_contacts().empty());
  double mean = 0.0;  // of two steps: their forces are by turns 3e-5 too large and too small
  for (int k = 0; k < 1000; ++k) {
    step_alone(simulation, *record);
    if (k >= 998) mean += 0.5 * carried(*record).y();
  }
  const double expected = bar.youngs_modulus * 0.04 * 0.04 * 0.002 / 0.12;
  CHECK(record->body_contacts().size() == 169);  // every node of its face
  CHECK(mean == Approx(-expected).epsilon(5e-6));
}

TEST_CASE("moving scenery: a block that a plane lifts weighs m (g + a)") {
  SimulationConfig config = block();
  SceneryMotion& motion = config.scenery[0].motion;
  motion.stroke = Vector3(0, 0.1, 0);
  motion.frequency = 0.5;
  Simulation simulation(config);
  const double mass = config.objects[0].model->body.mass;
  const double w = 2.0 * std::numbers::pi * motion.frequency;
  const auto record = std::make_unique<StepRecord>();
  double off = 0.0;
  double mean = 0.0;
  for (int k = 0; k < 2000; ++k) {
    step_alone(simulation, *record);
    if (k < 500) continue;
    const double a = 0.5 * 0.1 * w * w * std::cos(w * (record->time - 0.001));
    off = std::max(off, std::abs(carried(*record).y() / (mass * (kGravity + a)) - 1.0));
    mean += carried(*record).y() / (1500 * mass * kGravity);
    CHECK(std::abs(record->object[0].position.y() - kHalfEdge -
                   0.05 * (1.0 - std::cos(w * record->time))) < 1e-5);
  }
  INFO("off by " << off << ", mean " << mean);
  CHECK(off < 0.01);
}

TEST_CASE("moving scenery: a block on a belt comes to its speed at mu g, and then goes along") {
  SimulationConfig config = block();
  config.scenery[0].motion.velocity = Vector3(0.8, 0, 0);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 25; ++k) step_alone(simulation, *record);
  const double early = record->object[0].velocity.x();
  for (int k = 0; k < 50; ++k) step_alone(simulation, *record);
  const double gained = record->object[0].velocity.x() - early;
  CHECK(gained == Approx(kSceneryFriction * kGravity * 0.1).epsilon(1e-3));
  for (int k = 0; k < 425; ++k) step_alone(simulation, *record);
  CHECK(record->object[0].velocity.x() == Approx(0.8).epsilon(1e-3));
  const double slip = 0.5 * 0.8 * 0.8 / (kSceneryFriction * kGravity);
  CHECK(record->object[0].position.x() == Approx(0.8 - slip).epsilon(0.01));
}

TEST_CASE("moving scenery: a plane that shakes takes a block along up to mu g") {
  for (const double share : {0.8, 1.5}) {
    SimulationConfig config = block();
    SceneryMotion& motion = config.scenery[0].motion;
    motion.frequency = 1.0;
    const double w = 2.0 * std::numbers::pi;
    motion.stroke = Vector3(2.0 * share * kSceneryFriction * kGravity / (w * w), 0, 0);
    Simulation simulation(config);
    const auto record = std::make_unique<StepRecord>();
    double largest = 0.0;
    double apart = 0.0;
    for (int k = 0; k < 1000; ++k) {
      const Vector3 before = simulation.object().state().velocity;
      step_alone(simulation, *record);
      const double t = record->time;
      const double plane = 0.5 * motion.stroke.x() * (1.0 - std::cos(w * t));
      largest = std::max(largest,
                         std::abs(record->object[0].velocity.x() - before.x()) / simulation.dt());
      apart = std::max(apart, std::abs(record->object[0].position.x() - plane));
    }
    INFO(share << ": " << largest / (kSceneryFriction * kGravity) << " mu g, apart " << apart);
    if (share < 1.0) CHECK(apart < 1e-4);
    if (share > 1.0) CHECK(apart > 0.01);
    CHECK(largest < 1.2 * kSceneryFriction * kGravity);
  }
}

TEST_CASE("moving scenery: a turntable carries a block with r w^2 until friction gives") {
  const double radius = 0.3;
  for (const double share : {0.8, 1.3}) {
    SimulationConfig config = block();
    const double w = std::sqrt(share * kSceneryFriction * kGravity / radius);
    config.scenery[0].motion.angular_velocity = Vector3(0, w, 0);
    SimulationObject& object = config.objects[0];
    object.position.x() = radius;
    object.velocity = Vector3(0, 0, -w * radius);
    object.angular_velocity = Vector3(0, w, 0);
    Simulation simulation(config);
    const double mass = object.model->body.mass;
    const auto record = std::make_unique<StepRecord>();
    double most = radius;
    double inward = 0.0;
    for (int k = 0; k < 500; ++k) {
      step_alone(simulation, *record);
      const Vector3 at(record->object[0].position.x(), 0, record->object[0].position.z());
      most = std::max(most, at.norm());
      if (k >= 250) inward -= carried(*record).dot(at.normalized()) / 250;
    }
    INFO(share << ": out to " << most << " m, inward " << inward / (mass * radius * w * w));
    if (share < 1.0) CHECK(most < radius + 1e-3);
    if (share < 1.0) CHECK(inward == Approx(mass * radius * w * w).epsilon(0.02));
    if (share > 1.0) CHECK(most > 1.3 * radius);
  }
}

TEST_CASE("moving scenery: the same bits again, after a reset as well; nothing sleeps on it") {
  SimulationConfig config = block();
  config.scenery[0].motion.velocity = Vector3(0.2, 0, 0);
  config.sleep_time = 0.1;
  Simulation first(config);
  Simulation second(config);
  const auto one = std::make_unique<StepRecord>();
  const auto two = std::make_unique<StepRecord>();
  for (int k = 0; k < 77; ++k) step_alone(second, *two);
  second.reset();
  for (int k = 0; k < 400; ++k) {
    step_alone(first, *one);
    step_alone(second, *two);
    REQUIRE(one->object[0].position == two->object[0].position);
    REQUIRE(one->object[0].velocity == two->object[0].velocity);
    REQUIRE_FALSE(one->object[0].asleep);
  }
}
