#pragma once

#include "common/stability/transfer.hpp"

namespace irdm {

struct InverseStability {
  int growing = 0;               ///< modes of the force that grow
  double largest_modulus = 0.0;  ///< by which the slowest (or fastest growing) mode changes a step
  bool resolved = true;          ///< false: not known (ZeroCount)
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

/// A hand as the virtual one of irdm-bridge: a mass on a spring and a damper whose other end is at
/// rest.
struct Hand {
  double mass = 0.12;        ///< [kg], > 0
  double damping = 2.0;      ///< [N s/m], >= 0
  double stiffness = 300.0;  ///< [N/m], > 0
};

/// The loop of hand and object. The position at the end of step k gives the force of step k; it
/// moves the hand during step k + delay, held over the step.
struct HandLoop {
  Hand hand;
  double dt = 0.0;  ///< [s]
  int delay = 1;    ///< [steps], >= 1: the way there, the computation, the way back
};

/// Steps from a position to the hand's feeling its force: one for the computation, and twice the
/// one-way delay rounded up to whole steps.
int loop_delay(double one_way, double dt);

/// Displacement of the hand at the end of step s after 1 N held during step 0, as a series in w
/// [m/N]: sum_s H[s] w^s, in closed form.
std::complex<double> hand_transfer(const Hand& hand, double dt, std::complex<double> w);

/// Largest virtual coupling [N/m] such that the loop with it and with every smaller one is stable,
/// from kSoftestCoupling to kStiffestCoupling; 0 when already the smallest is not, infinity when
/// the largest is, NaN when it is not known (ZeroCount). The force f on the object solves
///
///     (C(w) + 1/k_vc) f = x,    x = -w^delay H(w) f
///
/// so that the loop grows where det(C(w) + w^delay H(w) + 1/k_vc) has a zero inside the unit
/// circle.
/// @param rigid dt^2/2 G [m/N], zero for a fixed body
/// @param radius of the circle that counts as the unit circle, see analyse_passivity
double largest_coupling(const DrivingPoint& record, const Matrix3& rigid, const HandLoop& loop,
                        double radius);

/// Growth that nobody feels: a body that hangs loosely on a spring hardly decays, and rounding must
/// not decide whether it does [1/s].
inline constexpr double kSlowestGrowth = 0.05;

inline constexpr double kSoftestCoupling = 1.0;
inline constexpr double kStiffestCoupling = 1e7;

/// Largest virtual coupling [N/m] that is stable at each of `count` surface nodes, evenly numbered,
/// for the loop that `irdm-precompute check` looks at by default: its hand, held forces, one step
/// of delay each way (largest_coupling()). Infinity: stable without one, rigid, or not known. Nodes
/// at which it is not known do not count.
double sampled_coupling(const Model& model, int count);

}  // namespace irdm
