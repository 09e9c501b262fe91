#pragma once

#include <Eigen/Dense>
#include <vector>

/// The static answer that stands in for columns of R that are not there: R[0], and after it what a
/// lasting force still adds, sum_{s>=1} R[s], at once for all pairs of nodes and along one curve,
///
///     K[s] = R[0] (s = 0),   K[s] = g[s] sum_{s>=1} R[s]  (s >= 1),   sum_s g[s] = 1
///
/// g is how a critically damped oscillator goes on after the first step. Such a K gives no energy
/// where no force direction adds more, as a share of its R[0], than that oscillator does: ratio.
namespace irdm {

/// Of a critically damped oscillator, sum_{s>=1} h[s] / h[0].
/// @param x omega dt, > 0
double settling_ratio(double x);

/// g[0..steps-1], g[0] = 0, of the oscillator of that ratio; all zero where steps is 1.
/// @param ratio taken as 1 where it is less: faster than that nothing settles
std::vector<double> settling_profile(double ratio, int steps);

/// v^T rest v / v^T first v for the v that the sum of the two yields most to, a little below the
/// largest that there is: of a free body 2 / (omega dt)^2 - 1 with omega that of its lowest mode.
/// @param first R[0], rest sum_{s>=1} R[s], square, taken as symmetric [m/N]
double settling_ratio(const Eigen::Ref<const Eigen::MatrixXf>& first,
                      const Eigen::Ref<const Eigen::MatrixXf>& rest);

}  // namespace irdm
