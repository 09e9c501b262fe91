#pragma once

#include <algorithm>
#include <memory>

#include "simulation/step/simulation.hpp"

namespace irdm::test {

/// Two cubes of 12 cm that run into each other, off their middles and spinning, and bounce apart.
/// @param on_plane they fall onto scenery besides, which the floor is not
inline SimulationConfig touching_cubes(std::shared_ptr<const Model> model, bool on_plane) {
  SimulationConfig config;
  config.objects.resize(2);
  for (SimulationObject& object : config.objects) {
    object.model = model;
    object.friction = {0.6, 0.5};
  }
  config.objects[0].position = Vector3(-0.0605, 0, 0);
  config.objects[0].velocity = Vector3(0.15, 0, 0);
  config.objects[0].angular_velocity = Vector3(0, 0.3, 0.1);
  config.objects[1].position = Vector3(0.0605, 0.004, 0.003);
  config.objects[1].velocity = Vector3(-0.15, 0, 0.02);
  config.objects[1].angular_velocity = Vector3(-0.2, 0, 0);
  if (!on_plane) return config;
  config.gravity = Vector3(0, -2, 0);
  SceneryConfig plane;
  plane.name = "plane";
  plane.shape = PlaneShape{};
  plane.position = Vector3(0, -0.0605, 0);
  config.scenery = {plane};
  return config;
}

/// The next step, with nobody there.
inline void step_alone(Simulation& simulation, StepRecord& record) {
  const StylusCommand nobody;
  simulation.step({&nobody, 1}, record);
}

/// Whether both are the same contact to the bit.
inline bool same(const BodyContactRecord& a, const BodyContactRecord& b) {
  return a.object == b.object && a.other == b.other && a.sample == b.sample &&
         a.slipping == b.slipping && a.triangle == b.triangle && a.weights == b.weights &&
         a.force == b.force && a.position == b.position && a.normal == b.normal &&
         a.slip == b.slip && a.area == b.area;
}

/// Whether two steps have the same contacts between bodies to the bit.
inline bool same_body_contacts(const StepRecord& a, const StepRecord& b) {
  return std::equal(a.body_contacts().begin(), a.body_contacts().end(), b.body_contacts().begin(),
                    b.body_contacts().end(), same);
}

}  // namespace irdm::test
