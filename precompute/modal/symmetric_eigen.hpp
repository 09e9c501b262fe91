#pragma once

#include <Eigen/Dense>

namespace irdm::precompute {

/// Largest matrix that the eigensolver takes: LAPACK's 32-bit workspace lengths end here.
inline constexpr Eigen::Index kMaxEigenSize = 32766;

struct EigenPairs {
  Eigen::VectorXd values;   ///< (n), increasing
  Eigen::MatrixXd vectors;  ///< (n, n), orthonormal columns
};

/// Bytes of working memory that symmetric_eigen needs for an (n, n) matrix, the matrix included.
double symmetric_eigen_bytes(Eigen::Index n);

/// All eigenvalues and eigenvectors of a symmetric matrix by LAPACK's divide and conquer (dsyevd).
/// Only the lower triangle is read. The matrix is taken over as storage: pass it with std::move.
/// Throws Error when the matrix is larger than kMaxEigenSize or LAPACK reports a failure.
EigenPairs symmetric_eigen(Eigen::MatrixXd matrix);

}  // namespace irdm::precompute
