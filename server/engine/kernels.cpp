#include "server/engine/kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "server/engine/kernel_lanes.hpp"

namespace irdm {
namespace {

using namespace kernel;

constexpr double kNothing = 1e-100;
using Lanes [[gnu::vector_size(kLanes * sizeof(double))]] = double;

template <std::size_t K>
[[gnu::always_inline]] inline Sums<K> dots_of(const double* a, const double* b,
                                              std::size_t n) noexcept {
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

constexpr std::array<std::array<std::size_t, 2>, 6> kPairs{
    {{0, 0}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}}};

[[gnu::always_inline]] inline Sums<9> moments_of(const double* a, const double* w, const double* x,
                                                 std::size_t n) noexcept {
  Lanes lanes[9] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    Lanes rows[3], weights, values;
    for (std::size_t j = 0; j < 3; ++j) std::memcpy(&rows[j], a + j * n + i, sizeof(Lanes));
    std::memcpy(&weights, w + i, sizeof weights);
    std::memcpy(&values, x + i, sizeof values);
    for (std::size_t j = 0; j < 3; ++j) lanes[j] += rows[j] * values;
    for (std::size_t p = 0; p < 6; ++p) {
      lanes[3 + p] += rows[kPairs[p][0]] * weights * rows[kPairs[p][1]];
    }
  }
  Sums<9> sums;
  for (std::size_t p = 0; p < 9; ++p) sums[p] = sum_of(lanes[p]);
  for (; i < n; ++i) {
    for (std::size_t j = 0; j < 3; ++j) sums[j] += a[j * n + i] * x[i];
    for (std::size_t p = 0; p < 6; ++p) {
      sums[3 + p] += a[kPairs[p][0] * n + i] * w[i] * a[kPairs[p][1] * n + i];
    }
  }
  return sums;
}

[[gnu::always_inline]] inline Sums<9> cross_moments_of(const double* a, const double* b,
                                                       const double* w, std::size_t n) noexcept {
  Lanes lanes[9] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    Lanes columns[3], weights;
    for (std::size_t k = 0; k < 3; ++k) std::memcpy(&columns[k], b + k * n + i, sizeof(Lanes));
    std::memcpy(&weights, w + i, sizeof weights);
    for (std::size_t j = 0; j < 3; ++j) {
      Lanes row;
      std::memcpy(&row, a + j * n + i, sizeof row);
      row *= weights;
      for (std::size_t k = 0; k < 3; ++k) lanes[3 * j + k] += row * columns[k];
    }
  }
  Sums<9> sums;
  for (std::size_t p = 0; p < 9; ++p) sums[p] = sum_of(lanes[p]);
  for (; i < n; ++i) {
    for (std::size_t p = 0; p < 9; ++p) sums[p] += a[p / 3 * n + i] * w[i] * b[p % 3 * n + i];
  }
  return sums;
}

template <typename Scalar>
[[gnu::always_inline]] inline void accumulate_nine_of(const std::array<double, 9>& w,
                                                      const std::array<const Scalar*, 9>& a,
                                                      double* y, std::size_t n) noexcept {
  const auto [a0, a1, a2, a3, a4, a5, a6, a7, a8] = a;
  const auto [w0, w1, w2, w3, w4, w5, w6, w7, w8] = w;
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    const double x = w0 * to_double(a0[i]) + w1 * to_double(a1[i]) + w2 * to_double(a2[i]);
    const double z = w3 * to_double(a3[i]) + w4 * to_double(a4[i]) + w5 * to_double(a5[i]);
    const double t = w6 * to_double(a6[i]) + w7 * to_double(a7[i]) + w8 * to_double(a8[i]);
    y[i] += (x + z) + t;
  }
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

// All steps ahead within the rows: eight of them in a register, for each x one product with what
// stands there in each row.
[[gnu::always_inline]] inline void add_part(const double* rows, std::size_t stride, const double* x,
                                            std::size_t n,
                                            double (&sums)[3][kStepsAhead]) noexcept {
  constexpr std::size_t kParts = kStepsAhead / kLanes;
  Lanes even[3][kParts] = {};
  Lanes odd[3][kParts] = {};
  const auto add = [&](std::size_t i, Lanes(&to)[3][kParts]) {
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t part = 0; part < kParts; ++part) {
        Lanes numbers;
        std::memcpy(&numbers, rows + r * stride + i + part * kLanes, sizeof numbers);
        to[r][part] += numbers * x[i];
      }
    }
  };
  std::size_t i = 0;
  for (; i + 2 <= n; i += 2) {
    add(i, even);
    add(i + 1, odd);
  }
  if (i < n) add(i, even);
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t m = 0; m < kStepsAhead; ++m) {
      sums[r][m] += even[r][m / kLanes][m % kLanes] + odd[r][m / kLanes][m % kLanes];
    }
  }
}

template <typename Scalar>
[[gnu::always_inline]] inline void add_ahead_of(const NodeRows<Scalar>& rows,
                                                std::span<const double> x, double weight,
                                                const std::array<double*, 3>& y) noexcept {
  double numbers[3][kAheadPart + kStepsAhead];
  double sums[3][kStepsAhead] = {};
  const std::size_t end = std::min(x.size(), rows.known);
  for (std::size_t i = 0; i < end; i += kAheadPart) {
    const std::size_t count = std::min(kAheadPart, end - i);
    const std::size_t known = std::min(count + kStepsAhead - 1, rows.known - i);
    for (std::size_t r = 0; r < 3; ++r) {
      const Scalar* row = rows.first + r * rows.stride + i;
      for (std::size_t j = 0; j < known; ++j) numbers[r][j] = to_double(row[j]);
      for (std::size_t j = known; j < count + kStepsAhead - 1; ++j) numbers[r][j] = 0.0;
    }
    add_part(numbers[0], kAheadPart + kStepsAhead, x.data() + i, count, sums);
  }
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t m = 0; m < kStepsAhead; ++m) y[r][m] += weight * sums[r][m];
  }
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

IRDM_KERNEL void add_products(const Rows<float>& rows, const double* x, std::size_t n,
                              double weight, double* y) noexcept {
  add_products_of(rows, x, n, weight, y);
}
IRDM_KERNEL void add_products(const Rows<double>& rows, const double* x, std::size_t n,
                              double weight, double* y) noexcept {
  add_products_of(rows, x, n, weight, y);
}

IRDM_KERNEL void add_ahead(const NodeRows<float>& rows, std::span<const double> x, double weight,
                           const std::array<double*, 3>& y) noexcept {
  add_ahead_of(rows, x, weight, y);
}
IRDM_KERNEL void add_ahead(const NodeRows<double>& rows, std::span<const double> x, double weight,
                           const std::array<double*, 3>& y) noexcept {
  add_ahead_of(rows, x, weight, y);
}

IRDM_KERNEL Sums<3> dot_three(const double* a, const double* b, std::size_t n) noexcept {
  return dots_of<3>(a, b, n);
}
IRDM_KERNEL Sums<6> dot_six(const double* a, const double* b, std::size_t n) noexcept {
  return dots_of<6>(a, b, n);
}

IRDM_KERNEL Sums<9> moments(const double* a, const double* w, const double* x,
                            std::size_t n) noexcept {
  return moments_of(a, w, x, n);
}
IRDM_KERNEL Sums<9> cross_moments(const double* a, const double* b, const double* w,
                                  std::size_t n) noexcept {
  return cross_moments_of(a, b, w, n);
}

IRDM_KERNEL void accumulate_nine(const std::array<double, 9>& w,
                                 const std::array<const float*, 9>& a, double* y,
                                 std::size_t n) noexcept {
  accumulate_nine_of(w, a, y, n);
}
IRDM_KERNEL void accumulate_nine(const std::array<double, 9>& w,
                                 const std::array<const double*, 9>& a, double* y,
                                 std::size_t n) noexcept {
  accumulate_nine_of(w, a, y, n);
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

IRDM_KERNEL void push_and_transit(const Transitions& A, const HeldForce& push, double* q, double* v,
                                  double* next_q, double* next_v, std::size_t n) noexcept {
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    const double pushed = q[i] + push.b1[i] * push.f[i];
    const double driven = v[i] + push.b2[i] * push.f[i];
    q[i] = pushed;
    v[i] = driven;
    next_q[i] = put_to_rest(A.a11[i] * pushed + A.a12[i] * driven);
    next_v[i] = put_to_rest(A.a21[i] * pushed + A.a22[i] * driven);
  }
}

}  // namespace irdm
