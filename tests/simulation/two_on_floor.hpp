#pragma once

#include "simulation/step/simulation_config.hpp"
#include "tests/support/fem_cube.hpp"

namespace irdm::test {

/// Two soft cubes that fall and turn, one on a floor, in front of two styluses, which are points
/// and can take hold.
inline SimulationConfig two_on_floor(ResponseKind kind = ResponseKind::kModal) {
  SimulationConfig config;
  config.gravity = Vector3(0, -0.5, 0);
  config.objects.resize(2);
  config.objects[0].model = fem_cube({3, 2000.0, 8.0, 0.002, 200}, kind);
  config.objects[0].angular_velocity = Vector3(0.3, 0.1, -0.2);
  config.objects[0].friction = {0.6, 0.5};
  config.objects[1] = config.objects[0];
  config.objects[1].position = Vector3(0.3, 0, 0);
  config.floor = FloorConfig{Vector3(0, 1, 0), -0.062, {0.5, 0.5}};
  config.styluses = {{0.0, 1000.0, 0.005}, {0.0, 1000.0, 0.005}};
  return config;
}

}  // namespace irdm::test
