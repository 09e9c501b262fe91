#pragma once

#include <memory>
#include <utility>

#include "simulation/step/simulation.hpp"
#include "tests/support/synthetic_model.hpp"

namespace irdm::test {

inline constexpr double kRodLength = 0.12;  ///< [m]
inline constexpr double kRodWidth = 0.012;  ///< [m]
inline constexpr double kRodMass = 0.05;    ///< [kg]

/// A rigid rod along y. The origin of its input mesh, which is the tool's tip, is the middle of its
/// lower end.
inline std::shared_ptr<const Model> rod(double dt = 0.002) {
  Model model = made_rigid(synthetic_cube(4, 1, 1, kRodLength));
  model.mesh.nodes.col(0) *= kRodWidth / kRodLength;
  model.mesh.nodes.col(2) *= kRodWidth / kRodLength;
  model.mesh.com_offset = Vector3(0, 0.5 * kRodLength, 0);
  model.dt = dt;
  model.body.mass = kRodMass;
  const double thin = kRodWidth * kRodWidth;
  const double across = kRodMass / 12.0 * (kRodLength * kRodLength + thin);
  model.body.inertia = Vector3(across, kRodMass / 6.0 * thin, across).asDiagonal();
  return std::make_shared<const Model>(std::move(model));
}

/// A rod whose tip is at the origin and that the only stylus leads.
inline SimulationConfig led_rod(const CouplingConstants& constants = {}, double dt = 0.002) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = rod(dt);
  config.objects[0].position = Vector3(0, 0.5 * kRodLength, 0);
  config.styluses[0].tool = ToolCoupling{0, constants};
  return config;
}

inline StylusCommand lead_to(const Vector3& tip,
                             const Quaternion& orientation = Quaternion::Identity()) {
  StylusCommand command{true, 0u, tip, std::nullopt};
  command.orientation = orientation;
  return command;
}

}  // namespace irdm::test
