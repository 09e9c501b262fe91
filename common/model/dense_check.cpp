#include "common/model/dense_check.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {
namespace {

constexpr int kDegreesOfFreedom = 16;
constexpr int kSteps = 32;
/// Of R(a, b) less R(b, a), as a share of the largest R(b, b): what stepping in time leaves is
/// far below.
constexpr double kDenseAsymmetry = 0.02;

// Evenly spread over [0, count).
std::vector<int> spread(int count, int most) {
  const int taken = std::min(count, most);
  std::vector<int> sample;
  for (int i = 0; i < taken; ++i) {
    sample.push_back(static_cast<int>(static_cast<long>(i) * count / taken));
  }
  return sample;
}

}  // namespace

DenseSamples::DenseSamples(int degrees_of_freedom, int steps)
    : degrees_of_freedom_(degrees_of_freedom),
      steps_(steps),
      sample_(spread(degrees_of_freedom, kDegreesOfFreedom)),
      step_sample_(spread(steps, kSteps)),
      peak_(static_cast<std::size_t>(degrees_of_freedom), 0.0),
      sum_(static_cast<std::size_t>(degrees_of_freedom), 0.0) {
  const auto count = static_cast<Eigen::Index>(sample_.size() * step_sample_.size());
  columns_.setZero(degrees_of_freedom, count);
  rows_.setZero(degrees_of_freedom, count);
}

template <typename Scalar>
void DenseSamples::add(int b, const Scalar* column) {
  const auto at = [&](int s, int a) {
    return static_cast<double>(column[static_cast<std::ptrdiff_t>(s) * degrees_of_freedom_ + a]);
  };
  auto& peak = peak_[static_cast<std::size_t>(b)];
  auto& sum = sum_[static_cast<std::size_t>(b)];
  for (int s = 0; s < steps_; ++s) {
    peak = std::max(peak, std::abs(at(s, b)));
    sum += at(s, b);
  }
  Eigen::Index place = 0;
  for (const int sampled : sample_) {
    for (const int s : step_sample_) {
      rows_(b, place) = at(s, sampled);
      if (sampled == b) {
        for (int a = 0; a < degrees_of_freedom_; ++a) columns_(a, place) = at(s, a);
      }
      ++place;
    }
  }
}

std::optional<std::string> DenseSamples::fault() const {
  const double largest = *std::ranges::max_element(peak_);
  for (std::size_t b = 0; b < peak_.size(); ++b) {
    if (sum_[b] > 0.0 || peak_[b] <= 0.0) continue;
    return "gives way against the force on degree of freedom " + std::to_string(b);
  }
  if (!((columns_ - rows_).cwiseAbs().maxCoeff() <= kDenseAsymmetry * largest)) {
    return "is not symmetric: a on b is not what b is on a";
  }
  return {};
}

template void DenseSamples::add(int, const float*);
template void DenseSamples::add(int, const double*);

}  // namespace irdm
