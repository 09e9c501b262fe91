#include <cstring>

#include "scene/scene_run.hpp"
#include "tests/c_interface/c_scene.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"

using namespace irdm;
using namespace irdm::test;

TEST_CASE("C interface: the forces and the weight of every object change its momentum") {
  const CScene scene;
  const OpenSimulation open(scene.text());
  REQUIRE(open.status == IRDM_OK);
  const SceneRun reference(TomlTable::parse_text(scene.text(), "scene"));
  const double dt = irdm_simulation_dt(open.handle);
  std::array<Vector3, 2> velocity{Vector3::Zero(), Vector3::Zero()};
  std::array<int, 5> of_kind{};
  double largest = 0.0;
  for (int k = 0; k < 400; ++k) {
    const auto commands = CScene::commands(k);
    std::array<irdm_stylus, 2> styluses{};
    REQUIRE(irdm_simulation_step(open.handle, commands.data(), 2, styluses.data()) == IRDM_OK);
    std::array<irdm_object, 2> objects{};
    REQUIRE(irdm_simulation_objects(open.handle, objects.data(), 2) == IRDM_OK);
    std::array<Vector3, 2> sum{Vector3::Zero(), Vector3::Zero()};
    Vector3 on_styluses = Vector3::Zero();
    for (const irdm_contact& contact : contacts_of(open.handle)) {
      const Vector3 force(contact.force[0], contact.force[1], contact.force[2]);
      sum.at(static_cast<std::size_t>(contact.object)) += force;
      if (contact.kind == IRDM_STYLUS) on_styluses -= force;
      ++of_kind.at(static_cast<std::size_t>(contact.kind));
    }
    for (const irdm_stylus& stylus : styluses) {
      on_styluses -= Vector3(stylus.force[0], stylus.force[1], stylus.force[2]);
    }
    REQUIRE(on_styluses.norm() < 1e-12);
    for (std::size_t i = 0; i < 2; ++i) {
      const double mass = reference.model(static_cast<int>(i))->body.mass;
      const Vector3 now(objects[i].velocity[0], objects[i].velocity[1], objects[i].velocity[2]);
      const Vector3 change = mass * (now - velocity[i]) / dt;
      const Vector3 missing = change - sum[i] - mass * Vector3(0, -9.81, 0);
      REQUIRE(missing.norm() < 1e-9);
      velocity[i] = now;
      largest = std::max(largest, sum[i].norm());
    }
  }
  CHECK(of_kind[IRDM_STYLUS] > 200);
  CHECK(of_kind[IRDM_SCENERY] > 1000);
  CHECK(of_kind[IRDM_OBJECT] > 1000);
  CHECK(largest > 1.0);
}

TEST_CASE("C interface: what it steps is what the simulation steps, to the bit") {
  const CScene scene;
  const OpenSimulation open(scene.text());
  REQUIRE(open.status == IRDM_OK);
  const SceneConfig config = read_scene(TomlTable::parse_text(scene.text(), "scene"));
  Simulation simulation(simulation_config(config, false));
  auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 300; ++k) {
    const auto commands = CScene::commands(k);
    std::array<StylusCommand, 2> same;
    for (std::size_t s = 0; s < 2; ++s) {
      if (commands[s].present == 0) continue;
      same[s].present = true;
      same[s].buttons = commands[s].buttons;
      same[s].tip = Vector3(commands[s].tip[0], commands[s].tip[1], commands[s].tip[2]);
    }
    std::array<irdm_stylus, 2> styluses{};
    REQUIRE(irdm_simulation_step(open.handle, commands.data(), 2, styluses.data()) == IRDM_OK);
    simulation.step(same, *record);
    for (std::size_t s = 0; s < 2; ++s) {
      for (int axis = 0; axis < 3; ++axis) {
        REQUIRE(styluses[s].force[axis] == record->stylus[s].force[axis]);
        REQUIRE(styluses[s].proxy[axis] == record->stylus[s].proxy[axis]);
      }
    }
  }
  CHECK(record->stylus[0].contact == ContactState::kHeld);
  CHECK(record->stylus[1].contact == ContactState::kTouching);
  // The surface: the body's place, and the point that a finger holds on it.
  std::size_t count = 0;
  REQUIRE(irdm_simulation_surface(open.handle, 0, nullptr, 0, &count) == IRDM_TOO_SMALL);
  std::vector<double> nodes(3 * count);
  REQUIRE(irdm_simulation_surface(open.handle, 0, nodes.data(), count, &count) == IRDM_OK);
  const SurfacePoint& held = record->object[0].contact[0].point;
  const Vector3 place = interpolate(held, [&](int node) -> Vector3 {
    return Vector3::Map(&nodes[3 * static_cast<std::size_t>(node)]);
  });
  // Of a fingertip the proxy is the mean place of the patch.
  CHECK((place - record->stylus[0].proxy).norm() < 0.005);
  REQUIRE(irdm_simulation_triangles(open.handle, 0, nullptr, 0, &count) == IRDM_TOO_SMALL);
  CHECK(count == 6 * 3 * 3 * 2);
}

TEST_CASE("C interface: a step allocates nothing, and a reset begins anew") {
  const CScene scene;
  const OpenSimulation open(scene.text());
  REQUIRE(open.status == IRDM_OK);
  std::array<irdm_stylus, 2> styluses{};
  const auto run = [&] {
    std::vector<double> forces;
    forces.reserve(300);
    const AllocationGuard guard;
    for (int k = 0; k < 300; ++k) {
      const auto commands = CScene::commands(k);
      irdm_simulation_step(open.handle, commands.data(), 2, styluses.data());
      forces.push_back(styluses[1].force[0]);
    }
    if (AllocationGuard::active()) CHECK(guard.count() == 0);
    return forces;
  };
  const std::vector<double> first = run();
  REQUIRE(irdm_simulation_reset(open.handle) == IRDM_OK);
  CHECK(run() == first);
  CHECK(first.back() != 0.0);
}

TEST_CASE("C interface: a saved state goes on to the same bits, in another simulation as well") {
  const CScene scene;
  const OpenSimulation first(scene.text());
  const OpenSimulation second(scene.text());
  REQUIRE(first.status == IRDM_OK);
  REQUIRE(second.status == IRDM_OK);
  const auto step = [](irdm_simulation* simulation, int k) {
    std::array<irdm_stylus, 2> styluses{};
    const auto commands = CScene::commands(k);
    irdm_simulation_step(simulation, commands.data(), 2, styluses.data());
    std::vector<double> forces(styluses[0].force, styluses[0].force + 3);
    for (const irdm_contact& contact : contacts_of(simulation)) {
      forces.insert(forces.end(), contact.force, contact.force + 3);
    }
    return forces;
  };
  for (int k = 0; k < 160; ++k) step(first.handle, k);
  const std::vector<char> state = state_of(first.handle);
  const std::vector<irdm_contact> contacts = contacts_of(first.handle);
  std::array<irdm_object, 2> objects{};
  irdm_simulation_objects(first.handle, objects.data(), 2);
  std::vector<std::vector<double>> expected;
  for (int k = 160; k < 300; ++k) expected.push_back(step(first.handle, k));
  CHECK(expected.back().size() > 9);
  for (irdm_simulation* simulation : {second.handle, first.handle}) {
    REQUIRE(irdm_simulation_load(simulation, state.data(), state.size(), nullptr, 0) == IRDM_OK);
    std::array<irdm_object, 2> there{};
    irdm_simulation_objects(simulation, there.data(), 2);
    CHECK(std::memcmp(there.data(), objects.data(), sizeof there) == 0);
    REQUIRE(contacts_of(simulation).size() == contacts.size());
    for (int k = 160; k < 300; ++k) {
      REQUIRE(step(simulation, k) == expected[static_cast<std::size_t>(k - 160)]);
    }
  }
}
