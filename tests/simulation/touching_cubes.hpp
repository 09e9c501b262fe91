#pragma once

#include <algorithm>
#include <memory>

#include "simulation/step/simulation.hpp"
#include "tests/simulation/pressed_cube.hpp"

namespace irdm::test {

/// Cubes one on the other on a plane of scenery, y = 0.
inline SimulationConfig stacked(int count, const FemCube& cube, const Friction& friction) {
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
  plane.name = "plane";
  plane.shape = PlaneShape{};
  plane.friction = friction;
  config.scenery = {plane};
  return config;
}

/// A step in which no stylus is there.
inline void step_alone(Simulation& simulation, StepRecord& record) {
  const StylusCommand nobody;
  simulation.step({&nobody, 1}, record);
}

/// Of all contacts between two bodies, on the first [N], W.
inline Vector3 force_between(const StepRecord& record, int object, int other) {
  Vector3 sum = Vector3::Zero();
  for (const BodyContactRecord& contact : record.body_contacts()) {
    if (contact.object == object && contact.other == other) sum += contact.force;
    if (contact.object == other && contact.other == object) sum -= contact.force;
  }
  return sum;
}

/// Of a whole world.
struct Momentum {
  Vector3 linear = Vector3::Zero();   ///< [kg m/s]
  Vector3 angular = Vector3::Zero();  ///< about the origin [kg m^2/s]
};

inline Momentum momentum(const Simulation& simulation) {
  Momentum sum;
  for (int i = 0; i < simulation.object_count(); ++i) {
    const RigidState& state = simulation.object(i).state();
    const Vector3 linear = simulation.object(i).model().body.mass * state.velocity;
    sum.linear += linear;
    sum.angular += state.position.cross(linear) + state.angular_momentum;
  }
  return sum;
}

/// The larger of both changes [kg m/s], [kg m^2/s].
inline double change(const Momentum& from, const Momentum& to) {
  return std::max((to.linear - from.linear).norm(), (to.angular - from.angular).norm());
}

}  // namespace irdm::test
