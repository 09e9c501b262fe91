#pragma once

#include <map>
#include <memory>

#include "precompute/dynamics/soft_body.hpp"
#include "precompute/dynamics/sparse_solver.hpp"

namespace irdm::precompute {

/// Steps a SoftBody by the implicit midpoint rule: with w the mean velocity of the step,
///
///     u_mid = u + h/2 w,   u' = u + h w,   v' = 2 w - v,
///     (2/h) M (w - v) = f_internal(u_mid, w) + f_external.
///
/// Second order; A-stable (unconditionally stable for linear elasticity), the same as Newmark's
/// average acceleration there when forces are constant over a step. Because the internal forces at
/// the midpoint have neither resultant nor torque, linear and angular momentum are conserved
/// exactly, up to the tolerance of the solution, for any step. Energy is conserved exactly for the
/// linear body only. For the corotational one without damping it has an error of second order that
/// builds up: a box of 3 x 2 x 2 cells, stretched by a fifth and spinning at 10 rad/s, gains 0.09 %
/// in 1 s and 0.2 % in 8 s at steps of 1 ms (4 times that at 2 ms, a quarter at 0.5 ms), whatever
/// the tolerance. Source: J. C. Simo, N. Tarnow and K. K. Wong, Exact energy-momentum conserving
/// algorithms and symplectic schemes for nonlinear dynamics, Comput. Methods Appl. Mech. Eng. 100
/// (1992).
///
/// The linear body takes one solution a step. The corotational one is iterated, with the matrix of
/// the rest shape turned with the body as a whole, which is factorised once for all steps of one
/// length; where that converges slowly (large strain) with the warped stiffness of the moment.
class ImplicitMidpoint {
 public:
  /// @param body must outlive this
  /// @param tolerance a step is solved when a correction is below this share of the largest speed
  /// that the state has had (mass-weighted), > 0
  explicit ImplicitMidpoint(const SoftBody& body, double tolerance = 1e-10);

  /// Factorises for steps of this length [s], > 0. Before the first step of that length, by one
  /// thread.
  void prepare(double h);

  /// What one trajectory needs besides its state.
  struct Workspace {
    double largest_speed = 0.0;            ///< sqrt of the largest v^T M v so far
    std::unique_ptr<SparseSolver> solver;  ///< for the moment's matrix; made when needed
    long solutions = 0;                    ///< linear systems solved so far
    long factorisations = 0;               ///< of the moment's matrix so far
  };

  /// Advances by one step of a prepared length under a constant force. Several threads may step
  /// different states. Throws Error when the step cannot be solved.
  /// @param force external, (3N) [N], W
  void step(BodyState& state, const Eigen::VectorXd& force, double h, Workspace& workspace) const;

 private:
  Eigen::SparseMatrix<double> matrix(const Eigen::SparseMatrix<double>& stiffness, double h) const;
  double speed(const Eigen::VectorXd& v) const;
  Eigen::VectorXd correction(const SparseSolver& solver, const Matrix3& Q, const BodyState& middle,
                             const Eigen::VectorXd& residual, double h) const;

  const SoftBody* body_;
  double tolerance_;
  Eigen::VectorXd mass3_;  // (3N)
  std::map<double, std::unique_ptr<SparseSolver>> solvers_;
};

}  // namespace irdm::precompute
