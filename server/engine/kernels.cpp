#include "server/engine/kernels.hpp"

#include <cmath>
#include <cstring>

// One copy of a function for each instruction set, chosen when the program is loaded. The
// sanitizers' run-time libraries are not ready that early.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(IRDM_SANITIZED)
#define IRDM_KERNEL __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define IRDM_KERNEL
#endif

namespace irdm {
namespace {

constexpr std::size_t kLanes = 8;
constexpr double kNothing = 1e-100;

template <typename Lanes>
[[gnu::always_inline]] inline double sum_of(const Lanes& lanes) noexcept {
  return ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) +
         ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]));
}

template <typename Scalar>
[[gnu::always_inline]] inline double dot_of(const Scalar* a, const double* b,
                                            std::size_t n) noexcept {
  double lanes[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) lanes[l] += static_cast<double>(a[i + l]) * b[i + l];
  }
  double sum = sum_of(lanes);
  for (; i < n; ++i) sum += static_cast<double>(a[i]) * b[i];
  return sum;
}

template <std::size_t K>
[[gnu::always_inline]] inline Sums<K> dots_of(const double* a, const double* b,
                                              std::size_t n) noexcept {
  using Lanes [[gnu::vector_size(kLanes * sizeof(double))]] = double;
  Lanes lanes[K] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    Lanes x;
    std::memcpy(&x, a + i, sizeof x);
    for (std::size_t k = 0; k < K; ++k) {
      Lanes y;
      std::memcpy(&y, b + k * n + i, sizeof y);
      lanes[k] += x * y;
    }
  }
  Sums<K> sums;
  for (std::size_t k = 0; k < K; ++k) {
    sums[k] = sum_of(lanes[k]);
    for (std::size_t j = i; j < n; ++j) sums[k] += a[j] * b[k * n + j];
  }
  return sums;
}

template <typename Scalar>
[[gnu::always_inline]] inline double weighted(const std::array<double, 3>& w, Scalar a, Scalar b,
                                              Scalar c) noexcept {
  return w[0] * static_cast<double>(a) + w[1] * static_cast<double>(b) +
         w[2] * static_cast<double>(c);
}

template <typename Scalar>
[[gnu::always_inline]] inline void combine_of(const std::array<double, 3>& w, const Scalar* a,
                                              const Scalar* b, const Scalar* c, double* y,
                                              std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) y[i] = weighted(w, a[i], b[i], c[i]);
}

template <typename Scalar>
[[gnu::always_inline]] inline void accumulate_of(const std::array<double, 3>& w, const Scalar* a,
                                                 const Scalar* b, const Scalar* c, double* y,
                                                 std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) y[i] += weighted(w, a[i], b[i], c[i]);
}

[[gnu::always_inline]] inline double put_to_rest(double x) noexcept {
  return std::abs(x) < kNothing ? 0.0 : x;
}

}  // namespace

IRDM_KERNEL double dot(const float* a, const double* b, std::size_t n) noexcept {
  return dot_of(a, b, n);
}
IRDM_KERNEL double dot(const double* a, const double* b, std::size_t n) noexcept {
  return dot_of(a, b, n);
}

IRDM_KERNEL Sums<3> dot_three(const double* a, const double* b, std::size_t n) noexcept {
  return dots_of<3>(a, b, n);
}
IRDM_KERNEL Sums<6> dot_six(const double* a, const double* b, std::size_t n) noexcept {
  return dots_of<6>(a, b, n);
}

IRDM_KERNEL void combine(const std::array<double, 3>& w, const float* a, const float* b,
                         const float* c, double* y, std::size_t n) noexcept {
  combine_of(w, a, b, c, y, n);
}
IRDM_KERNEL void combine(const std::array<double, 3>& w, const double* a, const double* b,
                         const double* c, double* y, std::size_t n) noexcept {
  combine_of(w, a, b, c, y, n);
}

IRDM_KERNEL void accumulate(const std::array<double, 3>& w, const float* a, const float* b,
                            const float* c, double* y, std::size_t n) noexcept {
  accumulate_of(w, a, b, c, y, n);
}
IRDM_KERNEL void accumulate(const std::array<double, 3>& w, const double* a, const double* b,
                            const double* c, double* y, std::size_t n) noexcept {
  accumulate_of(w, a, b, c, y, n);
}

IRDM_KERNEL void multiply(const double* a, const double* b, double* y, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) y[i] = a[i] * b[i];
}

IRDM_KERNEL void transit(const Transitions& A, const double* q, const double* v, double* next_q,
                         double* next_v, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    const double moved = A.a11[i] * q[i] + A.a12[i] * v[i];
    const double changed = A.a21[i] * q[i] + A.a22[i] * v[i];
    next_q[i] = put_to_rest(moved);
    next_v[i] = put_to_rest(changed);
  }
}

}  // namespace irdm
