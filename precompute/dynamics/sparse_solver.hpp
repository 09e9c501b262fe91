#pragma once

#include <Eigen/Sparse>
#include <memory>

#include "precompute/dynamics/soft_body.hpp"

namespace irdm::precompute {

/// (2/h + alpha) M + (h/2 + beta) K: what the mean velocity of a step of length h [s] is solved
/// with. alpha counts for all motions here; that rigid ones are not damped is mended afterwards.
Eigen::SparseMatrix<double> step_matrix(const SoftBody& body,
                                        const Eigen::SparseMatrix<double>& stiffness, double h);

/// Direct solver for symmetric positive definite matrices that all have the same pattern: the
/// symbolic factorisation is made at the first matrix and used again for the others. One thread at
/// a time factorises; any number may solve afterwards.
class SparseSolver {
 public:
  virtual ~SparseSolver() = default;
  /// Only the lower triangle is read. Throws Error when the matrix is not positive definite.
  virtual void factorise(const Eigen::SparseMatrix<double>& matrix) = 0;
  /// @param right one right-hand side a column
  virtual Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& right) const = 0;
};

/// CHOLMOD's supernodal Cholesky where the program was built with it (IRDM_WITH_CHOLMOD), else
/// Eigen's LDL^T.
std::unique_ptr<SparseSolver> make_sparse_solver();

/// Of this library itself, for comparison: always there.
std::unique_ptr<SparseSolver> make_eigen_solver();

/// "CHOLMOD" or "Eigen": what make_sparse_solver() makes.
const char* sparse_solver_name();

}  // namespace irdm::precompute
