#pragma once

#include <Eigen/Sparse>

#include "precompute/parallel/ranks.hpp"
#include "precompute/parallel/slepc_session.hpp"

namespace irdm::precompute {

/// The Cholesky factors of a matrix that rank 0 has: made by all ranks together (MUMPS), each keeps
/// a part of them. Rank 0 asks, the others follow the number that it gives (Ranks::first_says).
/// Within a SlepcSession. One thread, the one that made it.
class SharedFactors {
 public:
  explicit SharedFactors(const Ranks& ranks) : ranks_(ranks) {}

  /// Rank 0 only. Only the lower triangle is read. Throws Error when it is not positive definite.
  void factorise(const Eigen::SparseMatrix<double>& matrix);
  /// Rank 0 only.
  /// @param right one right-hand side a column
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& right) const;

  /// The other ranks: takes part in what the number of rank 0 asks for, which is below 0.
  void help(int number);

 private:
  void factorise_together(const Eigen::SparseMatrix<double, Eigen::RowMajor>& own_rows);
  void solve_together(int columns, double* right, double* solution) const;

  const Ranks& ranks_;
  PetscInt own_ = 0;  ///< rows: all of them on rank 0, none on the others
  SlepcObject<Mat, MatDestroy> factors_;
};

}  // namespace irdm::precompute
