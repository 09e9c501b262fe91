// A saved state: the steps that follow are the same to the bit, and its energy is what was put in.
#include <array>
#include <cmath>

#include "common/error.hpp"
#include "tests/simulation/saved_state.hpp"
#include "tests/simulation/touching_cubes.hpp"
#include "tests/simulation/two_on_floor.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fixed_box.hpp"
#include "tests/support/slotted_body.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

using One = std::array<StylusCommand, 1>;
using Two = std::array<StylusCommand, 2>;

struct Saved {
  ResponseKind kind;
  int before;  // steps
};

// Under a fingertip that slides and a point that takes hold.
SimulationConfig on_floor(ResponseKind kind) {
  SimulationConfig config = two_on_floor(kind);
  config.styluses[0].radius = 0.01;
  return config;
}

Two slide_and_hold(int k) {
  const double y = kHalfEdge + 0.01 - 2e-4 * std::min(k, 100);
  const double x = 0.02 * std::sin(0.02 * k);
  const bool grab = k % 200 > 80;
  return {at_tip({x, y, 0.003}), at_tip({0.3 + x, y, 0.003}, grab)};
}

}  // namespace

TEST_CASE("saved state: fingertips, holds and floor, each kind of response", "[slow]") {
  const auto [kind, before] =
      GENERATE(Saved{ResponseKind::kModal, 0}, Saved{ResponseKind::kModal, 1},
               Saved{ResponseKind::kModal, 150}, Saved{ResponseKind::kModal, 333},
               Saved{ResponseKind::kDense, 95}, Saved{ResponseKind::kDense, 333},
               Saved{ResponseKind::kCompressed, 95}, Saved{ResponseKind::kCompressed, 333});
  check_saved_state(on_floor(kind), before, 200, slide_and_hold);
}

TEST_CASE("saved state: spin loads a body, and it is saved with other settings") {
  SimulationConfig config = on_floor(ResponseKind::kModal);
  config.floor.reset();
  config.gravity.setZero();
  config.objects[0].inertial_loading = true;
  config.objects[0].angular_velocity = Vector3(0, 12, 1);
  Simulation first(config);
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 120; ++k) first.step(slide_and_hold(k), *record);
  Settings settings = first.settings();
  settings.gravity = Vector3(0.1, -1, 0);
  settings.object[0].material_damping = 3.0;
  settings.object[0].friction = {0.1, 0.1};
  settings.object[1].tether.stiffness = 2.0;
  first.set(settings);
  for (int k = 120; k < 150; ++k) first.step(slide_and_hold(k), *record);
  Simulation second(config);
  load(second, save(first));
  CHECK(second.settings() == settings);
  const auto other = std::make_unique<StepRecord>();
  for (int k = 150; k < 400; ++k) {
    first.step(slide_and_hold(k), *record);
    second.step(slide_and_hold(k), *other);
    REQUIRE(numbers_of(*record) == numbers_of(*other));
  }
}

TEST_CASE("saved state: a body that touches itself, with each kind of response", "[slow]") {
  const auto [kind, before] =
      GENERATE(Saved{ResponseKind::kModal, 4}, Saved{ResponseKind::kModal, 60},
               Saved{ResponseKind::kDense, 30}, Saved{ResponseKind::kCompressed, 30});
  SimulationConfig config;
  config.self_contact = true;
  config.objects.resize(1);
  config.objects[0].model = slotted_body({false, 2e4}, kind);
  config.objects[0].friction = {0.6, 0.5};
  config.styluses.resize(2);
  const Model& model = *config.objects[0].model;
  const int node = corner_node(model, Vector3(2.5 * kVoxel, 6 * kVoxel, 0));
  REQUIRE(node >= 0);
  const auto strike = [&](int k) {
    Two commands;
    if (k >= 6) return commands;
    commands[0].present = true;
    commands[0].given = GivenForce{
        ContactState::kTouching, {{node, node, node}, {1.0, 0.0, 0.0}}, Vector3(-0.5, 0, 0), 0};
    return commands;
  };
  check_saved_state(config, before, 150, strike);
}

TEST_CASE("saved state: bodies that fall asleep, and are woken", "[slow]") {
  SimulationConfig config = stacked(2, {.cells = 3, .youngs_modulus = 1e6}, {0.6, 0.5});
  config.sleep_time = 0.2;
  const auto poke = [](int k) {
    const bool near = k > 900;
    return One{at_tip(near ? Vector3(0, 4 * kHalfEdge - 0.0005, 0) : Vector3(0, 0.9, 0))};
  };
  const int before = GENERATE(100, 850);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < before; ++k) simulation.step(poke(k), *record);
  CHECK(record->object[0].asleep == (before == 850));
  check_saved_state(config, before, 300, poke);
}

TEST_CASE("saved state: scenery that moves") {
  SimulationConfig config = stacked(1, {.cells = 3, .youngs_modulus = 1e5}, {0.6, 0.5});
  config.scenery[0].motion.velocity = Vector3(0.05, 0, 0);
  config.scenery[0].motion.angular_velocity = Vector3(0, 0.3, 0);
  check_saved_state(config, 170, 200, [](int) { return One{}; });
}

TEST_CASE("saved state: one of another scene is refused") {
  Simulation two(on_floor(ResponseKind::kModal));
  Simulation one(stacked(1, {.cells = 3}, {0.6, 0.5}));
  CHECK_THROWS_AS(load(one, save(two)), Error);
  std::vector<std::byte> cut = save(two);
  cut.pop_back();
  CHECK_THROWS_AS(load(two, cut), Error);
  cut.resize(cut.size() + 2);
  CHECK_THROWS_AS(load(two, cut), Error);
}

// Without damping, what a force that is held does in a step is all that the deformation gets, to
// rounding: f . (u at the end - u at the start).
TEST_CASE("energy: of a body without damping it is the work that was done on it") {
  SimulationConfig config;
  config.objects.resize(1);
  Model undamped = *fem_cube({.cells = 3});
  std::get<ModalResponse>(undamped.response).decay_rate.setZero();
  config.objects[0].model = std::make_shared<const Model>(std::move(undamped));
  Simulation simulation(config);
  const SoftObject& object = simulation.object();
  const auto record = std::make_unique<StepRecord>();
  const int node = 5;
  const auto displaced = [&] {
    Points u;
    object.engine().displacement(u);
    return Vector3(u.row(node).transpose());
  };
  double work = 0.0;
  double largest = 0.0;
  const double begun = object.energy();
  Vector3 before = displaced();
  RigidState motion = object.state();
  for (int k = 0; k < 300; ++k) {
    StylusCommand command;
    command.present = k < 100;
    if (command.present) {
      const Vector3 force = 0.05 * std::sin(0.03 * k) * Vector3(0.3, -1.0, 0.2);
      command.given =
          GivenForce{ContactState::kTouching, {{node, node, node}, {1.0, 0.0, 0.0}}, force, 0};
    }
    simulation.step({&command, 1}, *record);
    const Vector3 now = displaced();
    const ContactRecord& contact = record->object[0].contact[0];
    if (contact.state != ContactState::kFree) {
      // The deformation's share, and that of the rigid motion: F dc + T . mean turn.
      work += contact.force.dot(now - before);
      const Vector3 force = record->object[0].halfway * contact.force;
      const RigidBody& rigid = object.rigid();
      const Vector3 turn =
          0.5 * simulation.dt() *
          (rigid.angular_velocity(motion) + rigid.angular_velocity(object.state()));
      const Vector3 torque =
          (object.state().angular_momentum - motion.angular_momentum) / simulation.dt();
      work += force.dot(object.state().position - motion.position) + torque.dot(turn);
    }
    before = now;
    motion = object.state();
    largest = std::max(largest, object.energy() - begun);
    INFO("step " << k << ": " << object.energy() - begun - work << " J off of " << largest);
    REQUIRE(object.energy() - begun == Approx(work).margin(1e-6 * largest + 1e-15));
  }
  CHECK(largest > 1e-5);
}

TEST_CASE("energy: a body that falls keeps it, and damping takes it") {
  SimulationConfig config;
  config.gravity = Vector3(0, -kGravity, 0);
  config.objects.resize(1);
  config.objects[0].model = fem_cube({.cells = 3});
  config.objects[0].velocity = Vector3(1, 3, 0);
  Simulation simulation(config);
  const double begun = simulation.object().energy();
  const double mass = config.objects[0].model->body.mass;
  CHECK(begun == Approx(0.5 * mass * 10.0));
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 300; ++k) step_alone(simulation, *record);
  CHECK(simulation.object().energy() == Approx(begun).epsilon(1e-9));
  CHECK(std::isnan(Simulation(on_floor(ResponseKind::kDense)).object().energy()));
}

// Linear: a force that stays leaves half of its work in a damped body that comes to rest.
TEST_CASE("energy: of a body at rest under a force it is half of force times displacement") {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fixed_box({.modes = GENERATE(0, 30)});
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  const Model& model = *config.objects[0].model;
  int top = 0;
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    if (model.mesh.rest_position(i).y() > model.mesh.rest_position(top).y()) top = i;
  }
  StylusCommand command;
  command.present = true;
  const Vector3 force(0.01, -0.02, 0.01);
  command.given = GivenForce{ContactState::kTouching, {{top, top, top}, {1.0, 0.0, 0.0}}, force, 0};
  double before = 1.0;
  for (int k = 0; k < 20000 && std::abs(simulation.object().energy() - before) > 0.0; ++k) {
    before = simulation.object().energy();
    for (int i = 0; i < 20; ++i) simulation.step({&command, 1}, *record);
  }
  Points u;
  simulation.object().engine().displacement(u);
  CHECK(simulation.object().energy() ==
        Approx(0.5 * force.dot(u.row(top).transpose())).epsilon(1e-6));
}
