#pragma once

#include <Eigen/Dense>

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

}  // namespace irdm
