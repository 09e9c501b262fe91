#pragma once

#include <Eigen/Core>

/// Decompositions of dense matrices of any size by Eigen, compiled in one source: each use of such
/// a template costs seconds to compile. They allocate, so they are for preparing and checking,
/// never for a step. Only the steps' own decompositions stay where they are used.
namespace irdm {

/// Eigenvalues of a symmetric matrix in ascending order, and its eigenvectors as columns.
struct SymmetricEigen {
  Eigen::VectorXd values;   ///< n
  Eigen::MatrixXd vectors;  ///< n x n, orthonormal
};

/// Returns eigenvalues and eigenvectors of a symmetric matrix, n x n; reads the lower triangle.
SymmetricEigen symmetric_eigenpairs(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// Returns the eigenvalues of a symmetric matrix, n x n, in ascending order.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// Returns eigenvalues and eigenvectors of a symmetric tridiagonal matrix, n x n.
/// @param diagonal n
/// @param off_diagonal n - 1
SymmetricEigen tridiagonal_eigenpairs(const Eigen::VectorXd& diagonal,
                                      const Eigen::VectorXd& off_diagonal);

/// Returns the n eigenvalues of a square matrix in no particular order.
Eigen::VectorXcd eigenvalues(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// Returns the X that minimises |A X - B|, by QR with column pivoting; A is m x n with m >= n.
Eigen::MatrixXd least_squares(const Eigen::Ref<const Eigen::MatrixXd>& A,
                              const Eigen::Ref<const Eigen::MatrixXd>& B);

/// Returns the X with A X = B for a symmetric positive definite A, n x n, by LDL^T.
Eigen::MatrixXd solve_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                const Eigen::Ref<const Eigen::MatrixXd>& B);

/// Returns the X with A X = B for a regular A, n x n, by LU with partial pivoting.
Eigen::MatrixXd solve_square(const Eigen::Ref<const Eigen::MatrixXd>& A,
                             const Eigen::Ref<const Eigen::MatrixXd>& B);

}  // namespace irdm
