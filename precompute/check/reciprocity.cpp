#include "precompute/check/reciprocity.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace irdm::precompute {

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
