#pragma once

#include <Eigen/Dense>

namespace irdm::precompute {

/// A sequence as a sum of decaying oscillations: y[l] is about Re sum_j amplitude_j pole_j^l.
struct PoleFit {
  Eigen::VectorXcd pole;  ///< inside the unit circle
  Eigen::VectorXcd amplitude;
  double error = 0.0;  ///< norm of what is left
};

inline constexpr int kMostPolePairs = 8;

/// The fewest pairs of poles, at most kMostPolePairs, that leave no more than `error`. The poles
/// are those of the sequence's own Hankel matrix (ESPRIT: R. Roy and T. Kailath, IEEE Trans. ASSP
/// 37, 1989), the amplitudes a least squares fit. A pole of 1 or beyond is moved to just inside.
PoleFit fit_poles(const Eigen::VectorXd& y, double error);

}  // namespace irdm::precompute
