#pragma once

#include <vector>

#include "common/config/toml_reader.hpp"
#include "precompute/dynamics/rigid_extraction.hpp"
#include "precompute/dynamics/soft_body.hpp"

namespace irdm::precompute {

/// [time_stepping]: how method = "time-stepping" obtains R. The first `hold` response intervals are
/// divided into steps of first_step, every further `hold` intervals into half as many (rounded
/// up), until a step is as long as last_step. Steps always divide the interval.
struct TimeSteppingConfig {
  Elasticity model = Elasticity::kCorotational;  ///< "corotational" | "linear"
  double first_step = 0.0;  ///< [s], divides dt; default: dt over a whole number, 1e-4 at most
  double last_step = 0.0;   ///< [s], divides dt, first_step at least; default: dt
  int hold = 10;            ///< 1..1 000 000
  /// Force that a column is simulated with [N], above 0; the response is divided by it. 0 (key left
  /// out): see default_force(). Much smaller ones lose digits to rounding
  /// (0.5 % of R at 1e-13 N on a cube of 12 cm), larger ones leave the linear range.
  double force = 0.0;
  RotationWeights rotation_weights = RotationWeights::kMass;  ///< "mass" | "none"
};

/// @param table of the configuration file; all keys are optional
/// @param dt response interval [s]
TimeSteppingConfig read_time_stepping(TomlTable table, double dt);

/// Number of steps in each of the T response intervals.
std::vector<int> step_schedule(const TimeSteppingConfig& config, double dt, int intervals);

/// 1e-4 of Young's modulus times the area that a node has, (volume / nodes)^(2/3): strains of 1e-4
/// next to the node, so that R is the linear response to about that share.
double default_force(const SoftBody& body, double youngs_modulus);

}  // namespace irdm::precompute
