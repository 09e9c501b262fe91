#pragma once

#include <optional>

#include "precompute/check/coupling_limit.hpp"
#include "precompute/check/inverse_stability.hpp"
#include "precompute/check/passivity.hpp"

namespace irdm::precompute {

/// What the checks find at one surface node.
struct NodeFindings {
  bool clamped = false;  ///< does not move: nothing below is filled
  Passivity passivity;
  InverseStability inverse;
  double stiffness = 0.0;          ///< in the first step, with the rigid body's own answer [N/m]
  double elastic_stiffness = 0.0;  ///< of R[0] alone [N/m]
  double coupling = 0.0;           ///< largest stable virtual coupling [N/m]
  double left = 0.0;               ///< largest |R_ii| in the last tenth of the record over its peak
};

/// Growth that nobody feels: a body that hangs loosely on a spring hardly decays, and rounding must
/// not decide whether it does [1/s].
inline constexpr double kSlowestGrowth = 0.05;

struct NodeConditions {
  HandLoop loop;
  double radius = 1.0;  ///< of the circle that counts as the unit circle, see analyse_passivity
};

NodeFindings analyse_node(const DrivingPoint& record, const Matrix3& rigid,
                          const NodeConditions& conditions);

}  // namespace irdm::precompute
