#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "simulation/step/simulation.hpp"
#include "tests/support/synthetic_model.hpp"

namespace irdm::test {

/// Two cubes that fall onto a floor, spin, and are touched; one of them changes its settings, and
/// for a while its first stylus is that of a bridge whose forces come late.
inline SimulationConfig two_cubes() {
  SimulationConfig config;
  config.gravity = Vector3(0, -2, 0);
  config.floor = FloorConfig{Vector3(0, 1, 0), -0.0605, {0.5, 0.4}};
  config.styluses = {{0.0, 300.0, 0.0}, {0.0, 0.0, 0.02}};
  Model model = synthetic_cube(3, 12, 10);
  add_centrifugal(model);
  config.objects.resize(2);
  for (SimulationObject& object : config.objects) {
    object.model = std::make_shared<const Model>(model);
    object.friction = {0.6, 0.5};
    object.angular_velocity = Vector3(0.2, 1.0, -0.3);
  }
  config.objects[0].inertial_loading = true;
  config.objects[1].position = Vector3(0.3, 0.1, 0);
  return config;
}

/// Step k of a run of them, played by two styluses. @param objects 1: the first one alone
inline void play_step(Simulation& simulation, int k, StepRecord& record) {
  if (k == 60) {
    Settings settings = simulation.settings();
    settings.gravity = Vector3(0, -1, 0);
    settings.object[0].inertial_loading = false;
    simulation.set(settings);
  }
  for (int age = 0; k > 30 && k < 50 && age < k % 4; ++age) {
    simulation.insert_delayed_force(
        0, {Vector3(0.001 * age, -0.002, 0.0005 * k), Vector3(0.01, 0.06, 0.005)}, age);
  }
  const double depth = std::min(2e-4 * k, 0.01);
  const std::array<StylusCommand, 2> commands{
      StylusCommand{k > 5, 0, Vector3(0.01, 0.064 - depth, 0.005), {}},
      StylusCommand{
          true, k > 20 && k < 90 ? kGrabButton : 0, Vector3(0.30 + 1e-4 * k, 0.17, 0.0), {}}};
  simulation.step(commands, record, k == 110);
  ContactModel model;
  if (k > 25 && k < 60) simulation.predict_horizon(0, commands[0].tip, 1, model);
}

}  // namespace irdm::test
