#include "simulation/engine/kernels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "simulation/engine/kernel_lanes.hpp"

namespace irdm {
namespace {

using namespace kernel;

constexpr double kNothing = 1e-100;

template <typename Scalar>
[[gnu::always_inline]] inline void accumulate_nine_of(const std::array<double, 9>& w,
                                                      const std::array<const Scalar*, 9>& a,
                                                      double* y, std::size_t n) noexcept {
  const auto [a0, a1, a2, a3, a4, a5, a6, a7, a8] = a;
  const auto [w0, w1, w2, w3, w4, w5, w6, w7, w8] = w;
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    const double x = w0 * static_cast<double>(a0[i]) + w1 * static_cast<double>(a1[i]) +
                     w2 * static_cast<double>(a2[i]);
    const double z = w3 * static_cast<double>(a3[i]) + w4 * static_cast<double>(a4[i]) +
                     w5 * static_cast<double>(a5[i]);
    const double t = w6 * static_cast<double>(a6[i]) + w7 * static_cast<double>(a7[i]) +
                     w8 * static_cast<double>(a8[i]);
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
IRDM_KERNEL double dot(const std::int16_t* a, const double* b, std::size_t n) noexcept {
  return dot_of(a, b, n);
}

IRDM_KERNEL double dot_magnitudes(const double* a, const double* b, std::size_t n) noexcept {
  double lanes[kLanes] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) lanes[l] += std::abs(a[i + l] * b[i + l]);
  }
  double sum = sum_of(lanes);
  for (; i < n; ++i) sum += std::abs(a[i] * b[i]);
  return sum;
}

IRDM_KERNEL void add_products(const Rows<float>& rows, const double* x, std::size_t n,
                              double weight, double* y) noexcept {
  add_products_of(rows, x, n, weight, y);
}
IRDM_KERNEL void add_products(const Rows<double>& rows, const double* x, std::size_t n,
                              double weight, double* y) noexcept {
  add_products_of(rows, x, n, weight, y);
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

// Numbers without a sign are in the order of their bits; what is no number comes last.
IRDM_KERNEL bool is_multiple(const double* a, double factor, const double* b,
                             std::size_t n) noexcept {
  constexpr double kRounding = 0x1p-50;
  std::uint64_t largest = 0;
  std::uint64_t most_off = 0;
  for (std::size_t i = 0; i < n; ++i) {
    largest = std::max(largest, std::bit_cast<std::uint64_t>(std::abs(a[i])));
    const double off = std::abs(a[i] - factor * b[i]);
    most_off = std::max(most_off, std::bit_cast<std::uint64_t>(off));
  }
  const auto allowed = kRounding * std::bit_cast<double>(largest);
  return std::isfinite(allowed) && std::bit_cast<double>(most_off) <= allowed;
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
