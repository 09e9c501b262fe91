#pragma once

#include <map>
#include <memory>

#include "precompute/dynamics/soft_body.hpp"
#include "precompute/dynamics/sparse_solver.hpp"

namespace irdm::precompute {

/// The implicit midpoint rule (see ImplicitMidpoint) for a linear body, of which several
/// trajectories take a step at once: one solution with as many right-hand sides.
class LinearMidpoint {
 public:
  /// @param body linear; must outlive this
  explicit LinearMidpoint(const SoftBody& body);

  /// Factorises for steps of this length [s], > 0. Before the first step of that length, by one
  /// thread.
  void prepare(double h);

  /// Advances by one step of a prepared length, one trajectory a column. Several threads may step
  /// different ones.
  /// @param u, v displacements [m] and velocities [m/s], (3N, m)
  /// @param force external, constant over the step, (3N, m) [N]
  void step(Eigen::MatrixXd& u, Eigen::MatrixXd& v, const Eigen::MatrixXd& force, double h) const;

 private:
  const SoftBody* body_;
  Eigen::VectorXd mass3_;                           // (3N)
  Eigen::SparseMatrix<double, Eigen::RowMajor> K_;  // (3N, 3N)
  Eigen::Matrix<double, Eigen::Dynamic, 6> rigid_;  // D, D^T M D = Id
  std::map<double, std::unique_ptr<SparseSolver>> solvers_;
};

/// Steps a SoftBody by the implicit midpoint rule with an energy-conserving mean force: with w the
/// mean velocity of the step,
///
///     u' = u + h w,   v' = 2 w - v,
///     (2/h) M (w - v) = f_mean(u, w, h) + f_external,      see SoftBody::mean_force().
///
/// Second order. Without external force, up to the tolerance of the solution and for any step:
/// linear and angular momentum are conserved, and energy is conserved without damping and never
/// grows with it, which makes the rule unconditionally stable. For the linear body f_mean is the
/// force at the midpoint, and the rule is Newmark's average acceleration where forces are constant
/// over a step. Source: J. C. Simo and N. Tarnow, The discrete energy-momentum method, ZAMP 43
/// (1992); the plain midpoint force would conserve both momenta but gain energy (0.09 % in 1 s for
/// a box of 3 x 2 x 2 cells, stretched by a fifth and spinning at 10 rad/s, at steps of 1 ms).
///
/// The linear body takes one solution a step. The corotational one is iterated, with the matrix of
/// the rest shape turned with the body as a whole, which is factorised once for all steps of one
/// length; where that converges slowly (large strain) with the warped stiffness of the moment.
class ImplicitMidpoint {
 public:
  /// @param body must outlive this
  /// @param tolerance a step is solved when a correction is below this share of the largest speed
  /// that the state has had (mass-weighted), or moves nodes by less than rounding does, > 0
  /// @param most_iterations after which a step is given up
  explicit ImplicitMidpoint(const SoftBody& body, double tolerance = 1e-10,
                            int most_iterations = 60);

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
  double speed(const Eigen::VectorXd& v) const;
  double speed_of_rounding(const Eigen::VectorXd& u, double h) const;
  Eigen::VectorXd correction(const SparseSolver& solver, const Matrix3& Q, const BodyState& middle,
                             const Eigen::VectorXd& residual, double h) const;

  const SoftBody* body_;
  double tolerance_;
  int most_iterations_;
  Eigen::VectorXd mass3_;  // (3N)
  std::map<double, std::unique_ptr<SparseSolver>> solvers_;
};

}  // namespace irdm::precompute
