#pragma once

#include <algorithm>
#include <optional>

#include "simulation/step/simulation.hpp"
#include "tests/support/fem_cube.hpp"

namespace irdm::test {

inline constexpr double kHalfEdge = 0.06;  ///< of the cube [m]
inline constexpr double kGravity = 9.81;   ///< [m/s^2]

/// The paper's cube, brought home by a tether and slowed down, so that it can be pressed by one
/// stylus.
inline SimulationConfig tethered(const FemCube& cube, double radius, const Friction& friction) {
  SimulationConfig config;
  config.objects.resize(1);
  SimulationObject& object = config.objects[0];
  object.model = fem_cube(cube);
  object.friction = friction;
  object.tether = {1000.0, 10.0};
  object.damping = {20.0, 20.0};
  config.styluses = {{radius, 2000.0, 0.0}};
  return config;
}

inline StylusCommand at_tip(const Vector3& tip, bool grab = false) {
  return {true, grab ? kGrabButton : 0u, tip, std::nullopt};
}

/// Comes down on the top at (x, z) to a depth within 0.5 s.
inline Vector3 press(double t, double depth, double x, double z) {
  const double s = std::clamp(t / 0.5, 0.0, 1.0);
  return {x, kHalfEdge + 0.005 - (0.005 + depth) * s * s * (3 - 2 * s), z};
}

}  // namespace irdm::test
