#pragma once

#include "precompute/check/transfer.hpp"

namespace irdm::precompute {

struct Passivity {
  /// Smallest eigenvalue of the Hermitian part of D over the circle, as a share of its largest:
  /// negative where the response gives out energy.
  double lowest;
  double angle;  ///< where: phase advance a step [rad], 0..pi
};

/// Whether a node can give out energy. A force that is held over a step does the work f[k] . (u[k]
/// - u[k-1]) in it, exactly; over any history the sum is not negative if and only if the Hermitian
/// part of D(w) = (1 - w) sum_s R_ii[s] w^s is positive semidefinite on the unit circle (Parseval).
/// For the record as it is: cut off at its last step.
/// @param radius of the circle in w, 1, or a little less for a record whose end was cut off for
/// this check alone: the statement holds on every circle inside as well, and the end weighs less
/// there
Passivity analyse_passivity(const DrivingPoint& record, double radius);

}  // namespace irdm::precompute
