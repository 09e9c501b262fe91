#pragma once

#include <Eigen/Dense>
#include <vector>

#include "common/geometry.hpp"
#include "common/model/model.hpp"

namespace irdm {

/// Exact transition over one step dt of q'' + 2 sigma q' + omega^2 q = f with f held constant
/// during the step:
///
///     q_{k+1} = a11 q_k + a12 v_k + b1 f        v_{k+1} = a21 q_k + a22 v_k + b2 f
///
/// q [kg^1/2 m], v its derivative, f [kg^-1/2 N] when the modes are mass-normalised.
struct HeldForceOscillator {
  double a11, a12, a21, a22;
  double b1, b2;
};

/// Transition of one oscillator, under-, critically or over-damped, to about 1e-14 relative in b1
/// and b2 and absolute in a11 and a22, however small omega dt and sigma dt are.
/// @param omega undamped angular frequency [rad/s], > 0
/// @param sigma decay rate [1/s], >= 0
/// @param dt step [s], > 0
HeldForceOscillator held_force_oscillator(double omega, double sigma, double dt);

/// h[0 .. steps-1]: q at the end of step s after f = 1 during step 0 and none afterwards, from rest
/// (equation (10): R[s] = Phi diag(h[s]) Phi^T). Its sum over all s is 1 / omega^2.
Eigen::VectorXd held_force_response(const HeldForceOscillator& oscillator, int steps);

/// h_i[s] of all modes: (steps, r). R[s] = Phi diag(h[s]) Phi^T. [m/N kg]
/// @param dt [s]
RowMatrix<double> held_responses(const ModalResponse& response, double dt, int steps);

// The static answer that stands in for columns of R that are not there: R[0], and after it what a
// lasting force still adds, sum_{s>=1} R[s], at once for all pairs of nodes and along one curve,
//
//     K[s] = R[0] (s = 0),   K[s] = g[s] sum_{s>=1} R[s]  (s >= 1),   sum_s g[s] = 1
//
// g is how a critically damped oscillator goes on after the first step. Such a K gives no energy
// where no force direction adds more, as a share of its R[0], than that oscillator does: ratio.

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

/// Products of the components of an angular velocity, in the order of the centrifugal data in a
/// model file: xx, yy, zz, yz, xz, xy.
inline constexpr int kSpinProducts = 6;
using SpinProducts = Eigen::Matrix<double, kSpinProducts, 1>;

/// @param w angular velocity [rad/s], B
inline SpinProducts spin_products(const Vector3& w) noexcept {
  SpinProducts q;
  q << w.x() * w.x(), w.y() * w.y(), w.z() * w.z(), w.y() * w.z(), w.x() * w.z(), w.x() * w.y();
  return q;
}

}  // namespace irdm
