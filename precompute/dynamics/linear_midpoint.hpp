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

}  // namespace irdm::precompute
