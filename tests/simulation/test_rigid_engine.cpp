// Bodies that do not deform.
#include <cmath>

#include "simulation/step/simulation.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using irdm::test::at_tip;
using irdm::test::kGravity;
using irdm::test::kHalfEdge;
using irdm::test::made_rigid;
using irdm::test::synthetic_cube;

namespace {

constexpr double kRigidCoupling = 2000.0;  // [N/m]

std::shared_ptr<const Model> rigid_cube(Support support = Support::kFloating) {
  Model model = made_rigid(synthetic_cube(4, 1, 1));
  model.body.support = support;
  return std::make_shared<const Model>(std::move(model));
}

SimulationConfig one_rigid_cube(double coupling = kRigidCoupling) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = rigid_cube();
  config.objects[0].friction = {0.6, 0.5};
  config.styluses = {{0.0, coupling, 0.005}};
  return config;
}

}  // namespace

TEST_CASE("rigid engine: no force moves or bends a node") {
  const auto model = rigid_cube();
  const auto engine = make_engine(model);
  const NodalForce force{3, Vector3(1, -2, 3)};
  engine->advance({&force, 1});
  engine->add_delayed_force({&force, 1}, 0);
  CHECK(engine->free_displacement(3) == Vector3::Zero());
  CHECK(engine->free_displacement_bound() == 0.0);
  CHECK(engine->free_change_bound() == 0.0);
  const std::array patches{ContactPatch({{0, 1, 2}, {0.2, 0.3, 0.5}}),
                           ContactPatch({{5, 5, 5}, {1.0, 0.0, 0.0}})};
  std::array<Vector3, 2> h{Vector3::Ones(), Vector3::Ones()};
  ContactMatrix compliance;
  engine->predict(patches, h, compliance);
  CHECK(h[0] == Vector3::Zero());
  CHECK(h[1] == Vector3::Zero());
  CHECK(compliance == ContactMatrix::Zero(6, 6));
  std::array<Vector3, 4> path;
  std::array<Matrix3, 4> response;
  path.fill(Vector3::Ones());
  response.fill(Matrix3::Ones());
  engine->predict_horizon(patches[0], {&force, 1}, path, response);
  for (const Vector3& place : path) CHECK(place == Vector3::Zero());
  for (const Matrix3& answer : response) CHECK(answer == Matrix3::Zero());
  response.fill(Matrix3::Ones());
  engine->cross_response(patches[0], patches[1], response);
  for (const Matrix3& answer : response) CHECK(answer == Matrix3::Zero());
  Points u = Points::Ones(2, 3);
  engine->displacement(u);
  CHECK(u == Points::Zero(model->mesh.surface_node_count(), 3));
}

TEST_CASE("rigid body: each step of a push changes momentum by force times dt, to rounding") {
  Simulation simulation(one_rigid_cube());
  const double mass = simulation.object().model().body.mass;
  StepRecord record;
  Vector3 velocity = Vector3::Zero();
  double off = 0.0;
  double largest = 0.0;
  for (int k = 0; k < 300; ++k) {
    const double t = k * simulation.dt();
    const Vector3 tip(0.02, kHalfEdge + 0.002 - 0.02 * t, 0.01);
    const StylusCommand command = at_tip(tip);
    simulation.step({&command, 1}, record);
    const Vector3& now = record.object[0].velocity;
    off =
        std::max(off, (mass * (now - velocity) / simulation.dt() + record.stylus[0].force).norm());
    largest = std::max(largest, record.stylus[0].force.norm());
    velocity = now;
  }
  CAPTURE(largest);
  CHECK(largest > 0.01);
  CHECK(off < 1e-12 * largest + 1e-12);
  CHECK(velocity.y() < -0.001);
  CHECK(record.object[0].angular_velocity.norm() > 0.001);
}

TEST_CASE("rigid body: a held point follows the tip, without a coupling spring exactly") {
  Simulation simulation(one_rigid_cube(0.0));
  StepRecord record;
  double off = 0.0;
  for (int k = 0; k < 500; ++k) {
    const double t = k * simulation.dt();
    const double swing = k < 5 ? 0.0 : 0.03 * std::sin(6.0 * (t - 5 * simulation.dt()));
    const StylusCommand command = at_tip({0.0, kHalfEdge - 1e-4, swing}, k > 2);
    simulation.step({&command, 1}, record);
    if (k < 10) continue;
    REQUIRE(record.stylus[0].contact == ContactState::kHeld);
    off = std::max(off, (record.stylus[0].proxy - command.tip).norm());
  }
  CHECK(off < 1e-4);
}

TEST_CASE("rigid body: two tips that hold it through springs share the weight") {
  SimulationConfig config = one_rigid_cube();
  config.gravity = Vector3(0, -kGravity, 0);
  config.objects[0].damping = {5.0, 5.0};
  config.styluses.push_back(config.styluses[0]);
  Simulation simulation(config);
  const double weight = simulation.object().model().body.mass * kGravity;
  StepRecord record;
  for (int k = 0; k < 3000; ++k) {
    const std::array commands{at_tip({kHalfEdge - 1e-4, 0.03, 0}, k > 0),
                              at_tip({-kHalfEdge + 1e-4, 0.03, 0}, k > 0)};
    simulation.step(commands, record);
  }
  CHECK(record.stylus[0].contact == ContactState::kHeld);
  CHECK(record.stylus[1].contact == ContactState::kHeld);
  const Vector3 sum = record.stylus[0].force + record.stylus[1].force;
  CHECK((sum - Vector3(0, -weight, 0)).norm() < 1e-3 * weight);
}

TEST_CASE("rigid body: fixed, it is felt as the coupling spring alone, pressed and held") {
  SimulationConfig config = one_rigid_cube();
  config.objects[0].model = rigid_cube(Support::kFixed);
  config.gravity = Vector3(0, -kGravity, 0);
  CHECK(takes_gravity(config.objects[0]));
  Simulation simulation(config);
  StepRecord record;
  const bool hold = GENERATE(false, true);
  for (int k = 0; k < 100; ++k) {
    const double depth = -0.001 + 4e-5 * k;
    const StylusCommand command = at_tip({0.013, kHalfEdge - depth, 0.008}, hold && k > 50);
    simulation.step({&command, 1}, record);
    if (k > 50 && hold) {
      CHECK(record.stylus[0].contact == ContactState::kHeld);
      continue;
    }
    const double expected = std::max(0.0, depth) * kRigidCoupling;
    CHECK((record.stylus[0].force - Vector3(0, expected, 0)).norm() < 1e-9);
  }
  CHECK(record.stylus[0].force.allFinite());
  CHECK(record.object[0].position == Vector3::Zero());
  CHECK(record.object[0].velocity == Vector3::Zero());
}

TEST_CASE("rigid body: dropped on a floor it comes to rest on it, and the floor carries it") {
  SimulationConfig config = one_rigid_cube();
  config.gravity = Vector3(0, -kGravity, 0);
  config.floor = FloorConfig{Vector3(0, 1, 0), -kHalfEdge - 0.01, {0.5, 0.5}};
  Simulation simulation(config);
  const double weight = simulation.object().model().body.mass * kGravity;
  StepRecord record;
  const StylusCommand nobody;
  for (int k = 0; k < 1000; ++k) {
    simulation.step({&nobody, 1}, record);
    REQUIRE(record.object[0].solved);
  }
  CHECK(record.object[0].position.y() == Approx(-0.01).margin(1e-4));
  CHECK(record.object[0].velocity.norm() < 1e-3);
  CAPTURE(record.object[0].floor_count, record.object[0].sweeps, record.object[0].residual);
  CHECK((record.object[0].floor_force - Vector3(0, weight, 0)).norm() < 0.01 * weight);
}

TEST_CASE("rigid body: a bridge believes what it is told, with another tip beside it as well") {
  SimulationConfig config = one_rigid_cube();
  config.styluses.push_back(config.styluses[0]);
  const bool other_holds = GENERATE(false, true);
  Simulation simulation(config);
  StepRecord record;
  ContactModel model;
  for (int k = 0; k < 50; ++k) {
    const double in = std::min(0.001, 1e-4 * k - 0.001);
    const std::array commands{at_tip({-kHalfEdge + in, 0.01, 0.02}),
                              at_tip({kHalfEdge - in, 0, 0}, other_holds && k > 15)};
    simulation.step(commands, record);
    if (k < 20) continue;
    simulation.predict_horizon(0, commands[0].tip, 25, model);
    REQUIRE(model.valid);
    CAPTURE(k, word(check(model)));
    CHECK(check(model) == ContactModelFault::kNone);
  }
  CHECK(record.stylus[1].contact == (other_holds ? ContactState::kHeld : ContactState::kTouching));
}

TEST_CASE("rigid body: inertial loading is refused, other settings are followed") {
  const auto model = rigid_cube();
  CHECK_THROWS_WITH(
      check_inertial_loading(*model, true, "cube.h5"),
      ContainsSubstring("cube.h5: is of a rigid body, which inertial_loading cannot bend"));
  CHECK_NOTHROW(check_inertial_loading(*model, false, "cube.h5"));
  const SimulationConfig config = one_rigid_cube();
  CHECK(settings_choice(config, 0) == SettingsChoice{});
  Simulation simulation(config);
  Settings settings = initial_settings(config);
  settings.gravity = Vector3(0, -kGravity, 0);
  simulation.set(settings);
  StepRecord record;
  const StylusCommand nobody;
  simulation.step({&nobody, 1}, record);
  CHECK(record.object[0].velocity.y() == Approx(-kGravity * simulation.dt()));
}
