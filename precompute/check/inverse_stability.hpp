#pragma once

#include "precompute/check/transfer.hpp"

namespace irdm::precompute {

struct InverseStability {
  int growing = 0;               ///< modes of the force that grow
  double largest_modulus = 0.0;  ///< by which the slowest (or fastest growing) mode changes a step
};

/// Whether the force on a held node is bounded when the tip is prescribed. The force loop solves
/// sum_s C[s] f[k-s] = x[k] for f[k], C[s] = R_ii[s] + dt^2 (s + 1/2) G: a recursion whose modes
/// are the zeros of det C(w). With G they are those of det((1-w)^2 R_ii(w) + (1+w) dt^2/2 G), which
/// is analytic inside the unit circle. Counted on circles of different radius by the argument
/// principle.
/// @param rigid dt^2/2 G [m/N], zero for a fixed body
/// @param radius of the circle that counts as the unit circle, see analyse_passivity
InverseStability analyse_inverse(const DrivingPoint& record, const Matrix3& rigid, double radius);

/// Stiffness that a hand meets within one step, in the direction in which it is largest [N/m].
double held_stiffness(const DrivingPoint& record, const Matrix3& rigid);

}  // namespace irdm::precompute
