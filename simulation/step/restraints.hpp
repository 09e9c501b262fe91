#pragma once

#include "simulation/step/settings.hpp"

namespace irdm {

/// Throws Error when a damping or tether is too strong for the step's dt: both act as they were at
/// its start.
void check_restraints(const SimulationConfig& config, const Settings& settings);

}  // namespace irdm
