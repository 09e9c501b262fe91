#pragma once

#include "simulation/engine/kernels.hpp"

/// Building blocks of the kernels, for their sources alone: everything is inlined into functions
/// that are compiled once for each instruction set.

// One copy of a function for each instruction set, chosen when the program is loaded. The
// sanitizers' run-time libraries are not ready that early.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(IRDM_SANITIZED)
#define IRDM_CHOOSES_KERNELS
#define IRDM_KERNEL __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define IRDM_KERNEL
#endif

namespace irdm::kernel {

constexpr std::size_t kLanes = 8;
/// Rows at a time: enough sums to hide how long an addition takes.
constexpr std::size_t kRows = 4;
/// Numbers of a row at a time that are converted for several uses: what stays in the first cache.
constexpr std::size_t kAheadPart = 512;
/// Numbers that a line of the cache holds.
template <typename Scalar>
constexpr std::size_t kLine = 64 / sizeof(Scalar);

template <typename Lanes>
[[gnu::always_inline]] inline double sum_of(const Lanes& lanes) noexcept {
  return ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) +
         ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]));
}

template <std::size_t K, typename Scalar>
[[gnu::always_inline]] inline void add_lanes(double (&lanes)[K][kLanes], const Scalar* rows,
                                             std::size_t stride, const double* x) noexcept {
  for (std::size_t k = 0; k < K; ++k) {
    for (std::size_t l = 0; l < kLanes; ++l)
      lanes[k][l] += static_cast<double>(rows[k * stride + l]) * x[l];
  }
}

/// Products of K rows with x, each in the same order. Many rows: what stands at the same places in
/// the K rows that follow is fetched into the cache's second level; it may be beyond the last row.
template <std::size_t K, bool kMany, typename Scalar>
[[gnu::always_inline]] inline void products_of(const Scalar* rows, std::size_t stride,
                                               const double* x, std::size_t n,
                                               double (&products)[K]) noexcept {
  double lanes[K][kLanes] = {};
  std::size_t i = 0;
  for (; i + kLine<Scalar> <= n; i += kLine<Scalar>) {
    for (std::size_t j = 0; j < kLine<Scalar>; j += kLanes) {
      add_lanes(lanes, rows + i + j, stride, x + i + j);
    }
    if constexpr (kMany) {
      for (std::size_t k = 0; k < K; ++k) __builtin_prefetch(rows + (K + k) * stride + i, 0, 2);
    }
  }
  for (; i + kLanes <= n; i += kLanes) add_lanes(lanes, rows + i, stride, x + i);
  for (std::size_t k = 0; k < K; ++k) {
    products[k] = sum_of(lanes[k]);
    for (std::size_t j = i; j < n; ++j)
      products[k] += static_cast<double>(rows[k * stride + j]) * x[j];
  }
}

template <typename Scalar>
[[gnu::always_inline]] inline double dot_of(const Scalar* a, const double* x,
                                            std::size_t n) noexcept {
  double product[1];
  products_of<1, false>(a, 0, x, n, product);
  return product[0];
}

template <std::size_t K, bool kMany, typename Scalar>
[[gnu::always_inline]] inline void add_some_of(const Scalar* rows, std::size_t stride,
                                               const double* x, std::size_t n, double weight,
                                               double* y) noexcept {
  double products[K];
  products_of<K, kMany>(rows, stride, x, n, products);
  for (std::size_t k = 0; k < K; ++k) y[k] += weight * products[k];
}

template <typename Scalar>
[[gnu::always_inline]] inline void add_products_of(const Rows<Scalar>& rows, const double* x,
                                                   std::size_t n, double weight,
                                                   double* y) noexcept {
  const auto row = [&](std::size_t r) { return rows.first + r * rows.stride; };
  std::size_t r = 0;
  for (; r + kRows <= rows.count; r += kRows) {
    add_some_of<kRows, true>(row(r), rows.stride, x, n, weight, y + r);
  }
  // A node's three, as the force step asks for them.
  if (r + 3 == rows.count) return add_some_of<3, false>(row(r), rows.stride, x, n, weight, y + r);
  for (; r < rows.count; ++r) add_some_of<1, false>(row(r), rows.stride, x, n, weight, y + r);
}

}  // namespace irdm::kernel
