#pragma once

#include <Eigen/Sparse>
#include <memory>

namespace irdm::precompute {

/// Direct solver for symmetric positive definite matrices that all have the same pattern: the
/// symbolic factorisation is made at the first matrix and used again for the others. One thread at
/// a time factorises; any number may solve afterwards.
class SparseSolver {
 public:
  virtual ~SparseSolver() = default;
  /// Only the lower triangle is read. Throws Error when the matrix is not positive definite.
  virtual void factorise(const Eigen::SparseMatrix<double>& matrix) = 0;
  virtual Eigen::VectorXd solve(const Eigen::VectorXd& right) const = 0;
};

/// Eigen's LDL^T. The place to put another one, such as CHOLMOD.
std::unique_ptr<SparseSolver> make_sparse_solver();

}  // namespace irdm::precompute
