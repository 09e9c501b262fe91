#include "simulation/step/restraints.hpp"

#include <algorithm>
#include <string>

#include "common/error.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm {
namespace {

// Damping and tether act as they were at the start of a step: stable as long as a step is short for
// them.
void check_restraints(const Model& model, const ObjectSettings& settings, const std::string& name) {
  if (model.body.support == Support::kFixed) return;  // it does not move at all
  const double dt = model.dt;
  if (std::max(settings.damping.linear, settings.damping.angular) * dt > 0.5) {
    throw Error(
        name, "has a damping that is too strong for its model's dt of " + std::to_string(dt) + " s",
        "use at most " + std::to_string(0.5 / dt) + " 1/s");
  }
  const double inertia =
      Eigen::SelfAdjointEigenSolver<Matrix3>(model.body.inertia, Eigen::EigenvaluesOnly)
          .eigenvalues()[0];
  const double stiffest = model.body.mass / (dt * dt);
  const double stiffest_angular = inertia / (dt * dt);
  if (settings.tether.stiffness > stiffest ||
      settings.tether.angular_stiffness > stiffest_angular) {
    throw Error(name, "has a tether that is too stiff for its mass and its model's dt",
                "use at most " + std::to_string(stiffest) + " N/m and " +
                    std::to_string(stiffest_angular) + " N m/rad");
  }
}

}  // namespace

void check_restraints(const SimulationConfig& config, const Settings& settings) {
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    check_restraints(*config.objects[i].model, settings.object[i],
                     "object " + std::to_string(i + 1));
  }
}

}  // namespace irdm
