#pragma once

#include <cstddef>

/// Inner loops of the response engines. Sums run in a fixed order that does not depend on alignment
/// or on the number of threads, so that equal inputs give equal bits. Real-time safe.
namespace irdm {

/// sum_i a[i] b[i], in double precision.
template <typename Scalar>
double dot(const Scalar* a, const double* b, std::size_t n) noexcept {
  constexpr std::size_t kLanes = 8;
  double lanes[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      lanes[l] += static_cast<double>(a[i + l]) * b[i + l];
    }
  }
  double sum = ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) +
               ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]));
  for (; i < n; ++i) sum += static_cast<double>(a[i]) * b[i];
  return sum;
}

/// y[i] += factor x[i].
template <typename Scalar>
void add_scaled(double factor, const Scalar* x, double* y, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) y[i] += factor * static_cast<double>(x[i]);
}

}  // namespace irdm
