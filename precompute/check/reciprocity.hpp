#pragma once

#include <vector>

#include "common/model/model.hpp"

namespace irdm::precompute {

/// How far R[s](a, b) = R[s](b, a) holds (Maxwell and Betti): every column is compared with some
/// columns that were read before.
class Reciprocity {
 public:
  /// A column to compare the others with: R[s](:, a), (T, 3n).
  void remember(int a, const RowMatrix<double>& column);

  /// Column b: R[s](a, b), (T, 3n).
  void add(int b, const RowMatrix<double>& column);

  /// Largest difference over all pairs seen and all steps, as a share of the geometric mean of the
  /// peaks of |R[s](a, a)| and |R[s](b, b)|, which bound |R[s](a, b)| of passive responses roughly.
  double largest_difference() const { return largest_; }
  int column_of_largest() const { return worst_; }
  int sample_size() const { return static_cast<int>(sample_.size()); }

 private:
  std::vector<int> sample_;
  std::vector<RowMatrix<float>> columns_;
  std::vector<double> peaks_;
  double largest_ = 0.0;
  int worst_ = 0;
};

/// `count` different numbers below `limit`, in increasing order, the same for every run; all of
/// them when there are not so many.
std::vector<int> fixed_sample(int limit, int count);

}  // namespace irdm::precompute
