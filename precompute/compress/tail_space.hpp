#pragma once

#include <vector>

#include "precompute/compress/dense_input.hpp"
#include "precompute/progress.hpp"

/// Where R lives after its first steps: the few directions in space and in time that all of its
/// columns share.
namespace irdm::precompute {

/// What one pass over R finds. m FIR steps, L = T - m of the tail.
struct Survey {
  int fir_steps = 0;              ///< m
  std::vector<float> fir;         ///< as in CompressedResponse: the mean of R and its transpose
  double norm = 0.0;              ///< Frobenius, of R; estimated from the sampled columns
  Eigen::VectorXd space_values;   ///< (3n) share of the norm that each direction carries
  Eigen::MatrixXd space_vectors;  ///< (3n, 3n) most important ones first, orthonormal
  Eigen::VectorXd time_values;    ///< (L)
  Eigen::MatrixXd time_vectors;   ///< (L, L)
};

/// All columns are read for the FIR part; the directions are those of some 250 columns, always
/// the same ones. Throws Error, as where R is zero.
Survey survey(const DenseInput& input, int fir_steps, const Console& console);

/// The fewest directions that leave out at most this share of the norm, at least 1.
int directions_for(const Eigen::VectorXd& values, double share);

/// Late R in the directions of space U (3n, r) and time G (L, K): R[m + l] is about
/// sum_k G(l, k) U M_k U^T.
struct Core {
  RowMatrix<float> space;     ///< U (3n, r)
  RowMatrix<double> time;     ///< G (L, K)
  Eigen::VectorXd weight;     ///< (r) share of the norm in each direction of space
  RowMatrix<float> matrices;  ///< (K r, r): M_k one below the other, symmetric

  Eigen::Index rank() const { return space.cols(); }
  Eigen::Index times() const { return time.cols(); }
};

/// A pass over all columns. Memory: K r^2 numbers.
/// @param r, K how many directions
Core project(const DenseInput& input, const Survey& survey, int r, int K, const Console& console);

}  // namespace irdm::precompute
