// Objects that touch each other and scenery.
#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>
#include <map>

#include "simulation/deformation/deformation.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

// Cubes one on the other on a plane.
SimulationConfig stacked(int count, const FemCube& cube, const Friction& friction) {
  SimulationConfig config;
  config.gravity = Vector3(0, -kGravity, 0);
  config.objects.resize(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    SimulationObject& object = config.objects[static_cast<std::size_t>(i)];
    object.model = fem_cube(cube);
    object.friction = friction;
    object.position = Vector3(0, (2 * i + 1) * kHalfEdge, 0);
    object.damping = {1.0, 1.0};
  }
  SceneryConfig plane;
  plane.shape = PlaneShape{};
  plane.friction = friction;
  config.scenery = {plane};
  return config;
}

void step(Simulation& simulation, StepRecord& record) {
  const StylusCommand nobody;
  simulation.step({&nobody, 1}, record);
}

}  // namespace

TEST_CASE("bodies: stacked") {
  const SimulationConfig config = stacked(3, {.cells = 4, .youngs_modulus = 2e4}, {0.6, 0.5});
  Simulation simulation(config);
  auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 3000; ++k) {
    step(simulation, *record);
    if (k % 200 != 0) continue;
    std::map<std::pair<int, int>, Vector3> sums;
    for (const auto& c : record->body_contacts()) {
      auto [it, fresh] = sums.try_emplace({c.object, c.other}, Vector3::Zero());
      it->second += c.force;
    }
    std::cout << k << " n " << record->body_contact_count << " sweeps " << record->object[0].sweeps
              << " res " << record->object[0].residual << " solved " << record->object[0].solved;
    for (const auto& [key, force] : sums) {
      std::cout << " (" << key.first << "," << key.second << ") " << force.transpose();
    }
    for (int i = 0; i < 3; ++i)
      std::cout << " y" << i << " " << record->object[i].position.transpose();
    std::cout << "\n";
  }
  std::cout << "weight " << config.objects[0].model->body.mass * kGravity << "\n";
}
