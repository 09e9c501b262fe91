#pragma once

#include <vector>

#include "common/model/model.hpp"
#include "common/stability/transfer.hpp"

namespace irdm::precompute {

struct Passivity {
  /// Smallest eigenvalue of the Hermitian part of D over the circle, as a share of its largest:
  /// negative where the response gives out energy.
  double lowest;
  double angle;  ///< where: phase advance a step [rad], 0..pi
};

/// Whether a node can give out energy. A force that is held over a step does the work f[k] . (u[k]
/// - u[k-1]) in it, exactly; over any history the sum is not negative if and only if the Hermitian
/// part of D(w) = (1 - w) sum_s R_ii[s] w^s is positive semidefinite on the unit circle (Parseval).
/// For the record as it is: cut off at its last step.
/// @param radius of the circle in w, 1, or a little less for a record whose end was cut off for
/// this check alone: the statement holds on every circle inside as well, and the end weighs less
/// there
Passivity analyse_passivity(const DrivingPoint& record, double radius);

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
