// Kernels on numbers of half precision. Products and their sums, sixteen at a time, are of single
// precision: a thousandth of what the numbers themselves are rounded by. Compilers do not turn
// to_float() into the processor's own conversion (F16C); where that is there it is written down.
#include <algorithm>

#include "simulation/engine/kernel_lanes.hpp"

#ifdef IRDM_CHOOSES_KERNELS
#include <immintrin.h>
#endif

namespace irdm {
namespace {

using namespace kernel;

constexpr std::size_t kHalfLanes = 16;
using AddProducts = void (*)(const Rows<Half>&, const double*, std::size_t, double,
                             double*) noexcept;

template <typename Sum>
[[gnu::always_inline]] inline double sum_of_sixteen(const Sum& lanes) noexcept {
  double pairs[kLanes];
  for (std::size_t l = 0; l < kLanes; ++l) {
    pairs[l] = static_cast<double>(lanes[l]) + static_cast<double>(lanes[l + kLanes]);
  }
  return sum_of(pairs);
}

/// The numbers beyond the last whole sixteen.
[[gnu::always_inline]] inline double rest_of(const Half* row, const double* x, std::size_t begin,
                                             std::size_t n) noexcept {
  double sum = 0.0;
  for (std::size_t j = begin; j < n; ++j) sum += to_double(row[j]) * x[j];
  return sum;
}

namespace portable {

template <std::size_t K, bool kMany>
void add_some(const Half* rows, std::size_t stride, const double* x, std::size_t n, double weight,
              double* y) noexcept {
  float lanes[K][kHalfLanes] = {};
  std::size_t i = 0;
  for (; i + kHalfLanes <= n; i += kHalfLanes) {
    for (std::size_t k = 0; k < K; ++k) {
      for (std::size_t l = 0; l < kHalfLanes; ++l) {
        lanes[k][l] += to_float(rows[k * stride + i + l]) * static_cast<float>(x[i + l]);
      }
    }
  }
  for (std::size_t k = 0; k < K; ++k) {
    y[k] += weight * (sum_of_sixteen(lanes[k]) + rest_of(rows + k * stride, x, i, n));
  }
}

}  // namespace portable

// The same for each way: rows in fours, and a node's three as the force step asks for them.
#define IRDM_ADD_ALL                                                                            \
  const auto row = [&](std::size_t r) { return rows.first + r * rows.stride; };                 \
  std::size_t r = 0;                                                                            \
  for (; r + kRows <= rows.count; r += kRows) {                                                 \
    add_some<kRows, true>(row(r), rows.stride, x, n, weight, y + r);                            \
  }                                                                                             \
  if (r + 3 == rows.count) return add_some<3, false>(row(r), rows.stride, x, n, weight, y + r); \
  for (; r < rows.count; ++r) add_some<1, false>(row(r), rows.stride, x, n, weight, y + r);

namespace portable {

void add(const Rows<Half>& rows, const double* x, std::size_t n, double weight,
         double* y) noexcept {
  IRDM_ADD_ALL
}

[[maybe_unused]] void convert(const Half* numbers, float* singles, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) singles[i] = to_float(numbers[i]);
}

}  // namespace portable

#ifdef IRDM_CHOOSES_KERNELS
#pragma GCC push_options
#pragma GCC target("avx512f,f16c")
namespace avx512 {

using Sixteen [[gnu::vector_size(64)]] = float;
using Eight [[gnu::vector_size(32)]] = float;

template <std::size_t K, bool kMany>
[[gnu::always_inline]] inline void add_some(const Half* rows, std::size_t stride, const double* x,
                                            std::size_t n, double weight, double* y) noexcept {
  Sixteen lanes[K] = {};
  std::size_t i = 0;
  for (; i + kHalfLanes <= n; i += kHalfLanes) {
    const Eight low = __builtin_convertvector(_mm512_loadu_pd(x + i), Eight);
    const Eight high = __builtin_convertvector(_mm512_loadu_pd(x + i + kLanes), Eight);
    const Sixteen b =
        __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for (std::size_t k = 0; k < K; ++k) {
      const Half* at = rows + k * stride + i;
      const __m256i numbers = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(at));
      lanes[k] += _mm512_maskz_cvtph_ps(0xFFFF, numbers) * b;
      if (kMany && i % kLine<Half> == 0) __builtin_prefetch(at + K * stride, 0, 2);
    }
  }
  for (std::size_t k = 0; k < K; ++k) {
    y[k] += weight * (sum_of_sixteen(lanes[k]) + rest_of(rows + k * stride, x, i, n));
  }
}

void add(const Rows<Half>& rows, const double* x, std::size_t n, double weight,
         double* y) noexcept {
  IRDM_ADD_ALL
}

}  // namespace avx512
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx2,f16c")
namespace avx2 {

using Eight [[gnu::vector_size(32)]] = float;

[[gnu::always_inline]] inline Eight singles(const double* x) noexcept {
  return _mm256_set_m128(_mm256_cvtpd_ps(_mm256_loadu_pd(x + 4)),
                         _mm256_cvtpd_ps(_mm256_loadu_pd(x)));
}

[[gnu::always_inline]] inline Eight singles(const Half* a) noexcept {
  return _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(a)));
}

template <std::size_t K, bool kMany>
[[gnu::always_inline]] inline void add_some(const Half* rows, std::size_t stride, const double* x,
                                            std::size_t n, double weight, double* y) noexcept {
  Eight low[K] = {};
  Eight high[K] = {};
  std::size_t i = 0;
  for (; i + kHalfLanes <= n; i += kHalfLanes) {
    const Eight first = singles(x + i);
    const Eight second = singles(x + i + kLanes);
    for (std::size_t k = 0; k < K; ++k) {
      const Half* at = rows + k * stride + i;
      low[k] += singles(at) * first;
      high[k] += singles(at + kLanes) * second;
      if (kMany && i % kLine<Half> == 0) __builtin_prefetch(at + K * stride, 0, 2);
    }
  }
  for (std::size_t k = 0; k < K; ++k) {
    float lanes[kHalfLanes];
    _mm256_storeu_ps(lanes, low[k]);
    _mm256_storeu_ps(lanes + kLanes, high[k]);
    y[k] += weight * (sum_of_sixteen(lanes) + rest_of(rows + k * stride, x, i, n));
  }
}

void add(const Rows<Half>& rows, const double* x, std::size_t n, double weight,
         double* y) noexcept {
  IRDM_ADD_ALL
}

void convert(const Half* numbers, float* singles, std::size_t n) noexcept {
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) _mm256_storeu_ps(singles + i, avx2::singles(numbers + i));
  for (; i < n; ++i) singles[i] = to_float(numbers[i]);
}

}  // namespace avx2
#pragma GCC pop_options
#endif
#undef IRDM_ADD_ALL

struct HalfKernels {
  AddProducts add;
  void (*convert)(const Half* numbers, float* singles, std::size_t n) noexcept;
};

HalfKernels best() noexcept {
#ifdef IRDM_CHOOSES_KERNELS
  __builtin_cpu_init();
  const bool converts = __builtin_cpu_supports("f16c");
  if (converts && __builtin_cpu_supports("avx512f")) return {avx512::add, avx2::convert};
  if (converts && __builtin_cpu_supports("avx2")) return {avx2::add, avx2::convert};
#endif
  return {portable::add, portable::convert};
}

const HalfKernels kKernels = best();

}  // namespace

double dot(const Half* a, const double* b, std::size_t n) noexcept {
  double product = 0.0;
  kKernels.add({a, n, 1}, b, n, 1.0, &product);
  return product;
}

void add_products(const Rows<Half>& rows, const double* x, std::size_t n, double weight,
                  double* y) noexcept {
  kKernels.add(rows, x, n, weight, y);
}

void add_ahead(const NodeRows<Half>& rows, std::span<const double> x, double weight,
               const std::array<double*, 3>& y) noexcept {
  constexpr std::size_t kForces = kAheadPart - kStepsAhead;
  float singles[3][kAheadPart];
  const std::size_t end = std::min(x.size(), rows.known);
  for (std::size_t i = 0; i < end; i += kForces) {
    const std::size_t known = std::min(rows.known - i, kAheadPart - 1);
    for (std::size_t r = 0; r < 3; ++r) {
      kKernels.convert(rows.first + r * rows.stride + i, singles[r], known);
    }
    const std::span<const double> part = x.subspan(i, std::min(kForces, end - i));
    add_ahead(NodeRows<float>{singles[0], kAheadPart, known}, part, weight, y);
  }
}

void add_effect(const NodeColumns<Half>& columns, const std::array<double, 3>& force,
                const std::array<double*, 3>& y, std::size_t n) noexcept {
  constexpr std::size_t kSteps = 64;
  float singles[9][kSteps];
  for (std::size_t i = 0; i < std::min(n, columns.known); i += kSteps) {
    const std::size_t asked = (n - i + kLanes - 1) / kLanes * kLanes;
    const std::size_t count = std::min({kSteps, asked, columns.known - i});
    for (std::size_t at = 0; at < 9; ++at) {
      const Half* row = columns.first + at % 3 * columns.row + at / 3 * columns.column;
      kKernels.convert(row + i, singles[at], count);
    }
    add_effect(NodeColumns<float>{singles[0], kSteps, 3 * kSteps, count}, force,
               {y[0] + i, y[1] + i, y[2] + i}, std::min(kSteps, n - i));
  }
}

void accumulate(const std::array<double, 3>& w, const Half* a, const Half* b, const Half* c,
                double* y, std::size_t n) noexcept {
  float singles[3][kAheadPart];
  for (std::size_t i = 0; i < n; i += kAheadPart) {
    const std::size_t count = std::min(kAheadPart, n - i);
    kKernels.convert(a + i, singles[0], count);
    kKernels.convert(b + i, singles[1], count);
    kKernels.convert(c + i, singles[2], count);
    accumulate(w, singles[0], singles[1], singles[2], y + i, count);
  }
}

}  // namespace irdm
