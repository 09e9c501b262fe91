#pragma once

#include <Eigen/Dense>

#include "precompute/modal/elastic_modes.hpp"
#include "precompute/modal/elastic_statics.hpp"

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

/// The lowest elastic modes by Lanczos on K^+ (shift-invert about zero, the rigid motions of a free
/// body deflated; Spectra), each eigenpair to 1e-10 of its eigenvalue. Shapes are those of all
/// modes to their residual, and orthonormal in the mass to rounding. Single-threaded but for the
/// solver; the same input gives the same bits. Throws Error when it does not converge, or when
/// there are motions without elastic energy besides the rigid ones.
/// @param count 1..most_lowest_modes(statics)
ElasticModes lowest_modes(const ElasticStatics& statics, int count);

/// The largest number that lowest_modes() takes: half of the elastic modes. Beyond it all modes by
/// LAPACK are the better way.
int most_lowest_modes(const ElasticStatics& statics);

/// Throws LostModes when the lowest of these modes has no elastic energy.
/// @param omega (r), increasing [rad/s]; not a number where rounding made its square negative
/// @param largest_square a scale of omega^2, as of ElasticStatics [1/s^2]
void check_lowest(const Eigen::VectorXd& omega, double largest_square);

}  // namespace irdm::precompute
