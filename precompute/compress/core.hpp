#pragma once

#include "precompute/compress/late_space.hpp"

namespace irdm::precompute {

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
