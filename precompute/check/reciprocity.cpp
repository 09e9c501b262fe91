#include "precompute/check/reciprocity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace irdm::precompute {
namespace {

struct Range {
  double lowest;
  double highest;
};

// Eigenvalues of a Hermitian 3 x 3 matrix in closed form (Smith, Comm. ACM 4, 1961).
Range eigenvalue_range(const Eigen::Matrix3cd& a) {
  const double mean = a.trace().real() / 3.0;
  const Eigen::Matrix3cd b = a - mean * Eigen::Matrix3cd::Identity();
  const double p = std::sqrt(b.squaredNorm() / 6.0);
  if (p == 0.0) return {mean, mean};
  const double r = (b / p).determinant().real() / 2.0;
  const double phi = std::acos(std::clamp(r, -1.0, 1.0)) / 3.0;
  return {mean + 2.0 * p * std::cos(phi + 2.0 * std::numbers::pi / 3.0),
          mean + 2.0 * p * std::cos(phi)};
}

}  // namespace

Passivity analyse_passivity(const DrivingPoint& record, double radius) {
  const int half = resolving_half_circle(record.cols());
  const MatrixHalfCircle response = transform(record, radius, half);
  double lowest = std::numeric_limits<double>::infinity();
  double highest = 0.0;
  int where = 0;
  for (int j = 0; j <= half; ++j) {
    const Eigen::Matrix3cd d =
        (1.0 - circle_point(radius, half, j)) * response[static_cast<std::size_t>(j)];
    const Range range = eigenvalue_range(0.5 * (d + d.adjoint()));
    if (range.lowest < lowest) {
      lowest = range.lowest;
      where = j;
    }
    highest = std::max(highest, range.highest);
  }
  if (!(highest > 0.0)) return {-std::numeric_limits<double>::infinity(), 0.0};
  return {lowest / highest, std::numbers::pi * where / half};
}

void Reciprocity::remember(int a, const RowMatrix<double>& column) {
  sample_.push_back(a);
  peaks_.push_back(column.col(a).cwiseAbs().maxCoeff());
  columns_.emplace_back(column.cast<float>());  // half the memory; its rounding is far below
}

void Reciprocity::add(int b, const RowMatrix<double>& column) {
  const double peak = column.col(b).cwiseAbs().maxCoeff();
  for (std::size_t i = 0; i < sample_.size(); ++i) {
    const double difference =
        (column.col(sample_[i]) - columns_[i].col(b).cast<double>()).cwiseAbs().maxCoeff();
    const double scale = std::sqrt(peak * peaks_[i]);
    const double share = difference == 0.0 ? 0.0 : difference / scale;  // 0 / 0 where clamped
    if (!(share <= largest_)) {
      largest_ = share;
      worst_ = b;
    }
  }
}

std::vector<int> fixed_sample(int limit, int count) {
  std::vector<int> all(static_cast<std::size_t>(limit));
  for (int i = 0; i < limit; ++i) all[static_cast<std::size_t>(i)] = i;
  std::vector<int> chosen;
  std::mt19937 random(1);
  std::sample(all.begin(), all.end(), std::back_inserter(chosen), count, random);
  return chosen;
}

}  // namespace irdm::precompute
