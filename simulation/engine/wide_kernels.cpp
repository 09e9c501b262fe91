// Kernels with more sums than one at a time, which stay in registers. Compilers do not find the way
// there: what they make of numbers in eights is several times slower where a register holds four.
// So the width of a register is written down, and one set of kernels made for each.
#include "simulation/engine/wide_kernels.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "simulation/engine/kernel_lanes.hpp"

namespace irdm {
namespace {

using namespace kernel;

/// A register, and what fills it once it is converted. Written down for each width, as GCC 12 takes
/// no vector for one in a template there.
template <std::size_t kBytes>
struct Register;
#define IRDM_REGISTER(BYTES)                                                                      \
  template <>                                                                                     \
  struct Register<BYTES> {                                                                        \
    using Doubles [[gnu::vector_size(BYTES)]] = double;                                           \
    using Singles [[gnu::vector_size(BYTES / 2)]] = float;                                        \
    [[gnu::always_inline]] static void convert(const float* numbers, Doubles& doubles) noexcept { \
      Singles singles;                                                                            \
      std::memcpy(&singles, numbers, sizeof singles);                                             \
      doubles = __builtin_convertvector(singles, Doubles);                                        \
    }                                                                                             \
  };
IRDM_REGISTER(16)
IRDM_REGISTER(32)
IRDM_REGISTER(64)
#undef IRDM_REGISTER

/// Eight lanes in registers of so many bytes. Sums end as sum_of() does.
template <std::size_t kBytes>
class Eight {
  static constexpr std::size_t kEach = kBytes / sizeof(double);
  static constexpr std::size_t kParts = kLanes / kEach;
  using Doubles = typename Register<kBytes>::Doubles;
  using InRow [[gnu::vector_size(kBytes), gnu::aligned(alignof(double)), gnu::may_alias]] = double;

 public:
  [[gnu::always_inline]] static Eight at(const double* numbers) noexcept {
    Eight eight;
    for (std::size_t p = 0; p < kParts; ++p) {
      std::memcpy(&eight.parts_[p], numbers + p * kEach, kBytes);
    }
    return eight;
  }
  [[gnu::always_inline]] static Eight at(const float* numbers) noexcept {
    Eight eight;
    for (std::size_t p = 0; p < kParts; ++p) {
      Register<kBytes>::convert(numbers + p * kEach, eight.parts_[p]);
    }
    return eight;
  }
  [[gnu::always_inline]] static Eight all(double number) noexcept {
    Eight eight;
    for (std::size_t p = 0; p < kParts; ++p) eight.parts_[p] = Doubles{} + number;
    return eight;
  }
  [[gnu::always_inline]] void write(double* numbers) const noexcept {
    std::memcpy(numbers, &parts_, sizeof parts_);
  }
  /// The same for what is used several times: volatile, since otherwise compilers read it again for
  /// each use.
  [[gnu::always_inline]] static Eight kept_at(const double* numbers) noexcept {
    Eight eight;
    for (std::size_t p = 0; p < kParts; ++p) {
      eight.parts_[p] = *reinterpret_cast<const volatile InRow*>(numbers + p * kEach);
    }
    return eight;
  }

  [[gnu::always_inline]] void add_product(const Eight& a, const Eight& b) noexcept {
    for (std::size_t p = 0; p < kParts; ++p) parts_[p] += a.parts_[p] * b.parts_[p];
  }
  [[gnu::always_inline]] Eight plus(const Eight& b) const noexcept {
    Eight sum;
    for (std::size_t p = 0; p < kParts; ++p) sum.parts_[p] = parts_[p] + b.parts_[p];
    return sum;
  }
  [[gnu::always_inline]] Eight times(const Eight& b) const noexcept {
    Eight product;
    for (std::size_t p = 0; p < kParts; ++p) product.parts_[p] = parts_[p] * b.parts_[p];
    return product;
  }
  [[gnu::always_inline]] double sum() const noexcept {
    if constexpr (kParts == 1) {
      return sum_of_four(__builtin_shufflevector(parts_[0], parts_[0], 0, 1, 2, 3) +
                         __builtin_shufflevector(parts_[0], parts_[0], 4, 5, 6, 7));
    } else if constexpr (kParts == 2) {
      return sum_of_four(parts_[0] + parts_[1]);
    } else {
      const auto low = parts_[0] + parts_[2];
      const auto high = parts_[1] + parts_[3];
      return (low[0] + low[1]) + (high[0] + high[1]);
    }
  }

 private:
  template <typename Four>
  [[gnu::always_inline]] static double sum_of_four(const Four& four) noexcept {
    return (four[0] + four[1]) + (four[2] + four[3]);
  }

  Doubles parts_[kParts];
};

/// Eight steps at a time, the last ones of them too where so many are known.
template <std::size_t kBytes, typename Scalar>
[[gnu::always_inline]] inline void add_effect_of(const NodeColumns<Scalar>& columns,
                                                 const std::array<double, 3>& force,
                                                 const std::array<double*, 3>& y,
                                                 std::size_t n) noexcept {
  using Lanes = Eight<kBytes>;
  const Lanes weights[3] = {Lanes::all(force[0]), Lanes::all(force[1]), Lanes::all(force[2])};
  std::size_t i = 0;
  for (; i < n && i + kLanes <= columns.known; i += kLanes) {
    for (std::size_t r = 0; r < 3; ++r) {
      const Scalar* at = columns.first + r * columns.row + i;
      Lanes sum = weights[0].times(Lanes::at(at));
      sum.add_product(weights[1], Lanes::at(at + columns.column));
      sum.add_product(weights[2], Lanes::at(at + 2 * columns.column));
      Lanes::at(y[r] + i).plus(sum).write(y[r] + i);
    }
  }
  for (; i < std::min(n, columns.known); ++i) {
    for (std::size_t r = 0; r < 3; ++r) {
      const Scalar* at = columns.first + r * columns.row + i;
      y[r][i] += force[0] * static_cast<double>(at[0]) +
                 force[1] * static_cast<double>(at[columns.column]) +
                 force[2] * static_cast<double>(at[2 * columns.column]);
    }
  }
}

template <std::size_t kBytes, std::size_t K>
[[gnu::always_inline]] inline Sums<K> dots_of(const double* a, const double* b,
                                              std::size_t n) noexcept {
  using Lanes = Eight<kBytes>;
  Lanes lanes[K] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    const Lanes x = Lanes::at(a + i);
    for (std::size_t k = 0; k < K; ++k) lanes[k].add_product(x, Lanes::at(b + k * n + i));
  }
  Sums<K> sums;
  for (std::size_t k = 0; k < K; ++k) {
    sums[k] = lanes[k].sum();
    for (std::size_t j = i; j < n; ++j) sums[k] += a[j] * b[k * n + j];
  }
  return sums;
}

template <std::size_t kBytes>
[[gnu::always_inline]] inline Sums<9> moments_of(const double* a, const double* w, const double* x,
                                                 std::size_t n) noexcept {
  using Lanes = Eight<kBytes>;
  Lanes lanes[9] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    const Lanes rows[3] = {Lanes::at(a + i), Lanes::at(a + n + i), Lanes::at(a + 2 * n + i)};
    const Lanes weights = Lanes::at(w + i);
    const Lanes values = Lanes::at(x + i);
    for (std::size_t j = 0; j < 3; ++j) lanes[j].add_product(rows[j], values);
    for (std::size_t j = 0, p = 3; j < 3; ++j) {
      const Lanes weighted = rows[j].times(weights);
      for (std::size_t k = 0; k <= j; ++k) lanes[p++].add_product(weighted, rows[k]);
    }
  }
  Sums<9> sums;
  for (std::size_t p = 0; p < 9; ++p) sums[p] = lanes[p].sum();
  for (; i < n; ++i) {
    for (std::size_t j = 0; j < 3; ++j) sums[j] += a[j * n + i] * x[i];
    for (std::size_t j = 0, p = 3; j < 3; ++j) {
      for (std::size_t k = 0; k <= j; ++k) sums[p++] += a[j * n + i] * w[i] * a[k * n + i];
    }
  }
  return sums;
}

template <std::size_t kBytes>
[[gnu::always_inline]] inline Sums<9> cross_moments_of(const double* a, const double* b,
                                                       const double* w, std::size_t n) noexcept {
  using Lanes = Eight<kBytes>;
  Lanes lanes[9] = {};
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    const Lanes columns[3] = {Lanes::at(b + i), Lanes::at(b + n + i), Lanes::at(b + 2 * n + i)};
    const Lanes weights = Lanes::at(w + i);
    for (std::size_t j = 0; j < 3; ++j) {
      const Lanes row = Lanes::at(a + j * n + i).times(weights);
      for (std::size_t k = 0; k < 3; ++k) lanes[3 * j + k].add_product(row, columns[k]);
    }
  }
  Sums<9> sums;
  for (std::size_t p = 0; p < 9; ++p) sums[p] = lanes[p].sum();
  for (; i < n; ++i) {
    for (std::size_t p = 0; p < 9; ++p) sums[p] += a[p / 3 * n + i] * w[i] * b[p % 3 * n + i];
  }
  return sums;
}

using AheadSums = double[3][kStepsAhead];

/// Eight numbers of each row at a time with the eight forces that meet them m steps ahead: x[j - m]
/// meets numbers[j]. `width` is a multiple of eight; kStepsAhead - 1 forces stand before x.
template <std::size_t kBytes>
[[gnu::always_inline]] inline void add_part(const double (&numbers)[3][kAheadPart], const double* x,
                                            std::size_t width, AheadSums& sums) noexcept {
  using Lanes = Eight<kBytes>;
  // Three quarters of the registers hold sums.
  constexpr std::size_t kRegisters = kBytes == 64 ? 32 : 16;
  constexpr std::size_t kAtOnce = kRegisters / 4 / (sizeof(Lanes) / kBytes);
  static_assert(kStepsAhead % kAtOnce == 0 && kAheadPart % kLanes == 0);
  static_assert(kAheadPart >= kStepsAhead);
  for (std::size_t first = 0; first < kStepsAhead; first += kAtOnce) {
    Lanes lanes[3][kAtOnce] = {};
    for (std::size_t j = 0; j < width; j += kLanes) {
      Lanes rows[3];
      for (std::size_t r = 0; r < 3; ++r) rows[r] = Lanes::at(numbers[r] + j);
      for (std::size_t m = 0; m < kAtOnce; ++m) {
        const Lanes forces = Lanes::kept_at(x + j - (first + m));
        for (std::size_t r = 0; r < 3; ++r) lanes[r][m].add_product(rows[r], forces);
      }
    }
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t m = 0; m < kAtOnce; ++m) sums[r][first + m] += lanes[r][m].sum();
    }
  }
}

template <std::size_t kBytes, typename Scalar>
[[gnu::always_inline]] inline void add_ahead_of(const NodeRows<Scalar>& rows,
                                                std::span<const double> x, double weight,
                                                const std::array<double*, 3>& y) noexcept {
  alignas(64) double numbers[3][kAheadPart];
  alignas(64) double forces[kStepsAhead + kAheadPart];  // with those that came before
  AheadSums sums = {};
  const std::size_t end = std::min(x.size() + kStepsAhead - 1, rows.known);
  std::fill_n(forces, kStepsAhead, 0.0);
  for (std::size_t begin = 0; begin < end; begin += kAheadPart) {
    const std::size_t count = std::min(kAheadPart, end - begin);
    const std::size_t width = (count + kLanes - 1) / kLanes * kLanes;
    for (std::size_t r = 0; r < 3; ++r) {
      const Scalar* row = rows.first + r * rows.stride + begin;
      for (std::size_t j = 0; j < count; ++j) numbers[r][j] = static_cast<double>(row[j]);
      std::fill(numbers[r] + count, numbers[r] + width, 0.0);
    }
    if (begin > 0) std::copy_n(forces + kAheadPart, kStepsAhead, forces);
    double* const now = forces + kStepsAhead;
    const std::span<const double> left = x.subspan(std::min(begin, x.size()));
    const std::size_t given = std::min(width, left.size());
    std::copy_n(left.data(), given, now);
    std::fill(now + given, now + width, 0.0);
    add_part<kBytes>(numbers, now, width, sums);
  }
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t m = 0; m < kStepsAhead; ++m) y[r][m] += weight * sums[r][m];
  }
}

// A set of them: IRDM_WIDE_KERNELS(its name, width of a register [byte], attributes)
#define IRDM_WIDE_KERNELS(NAME, BYTES, ...)                                                     \
  namespace NAME {                                                                              \
  __VA_ARGS__ Sums<3> dot_three(const double* a, const double* b, std::size_t n) noexcept {     \
    return dots_of<BYTES, 3>(a, b, n);                                                          \
  }                                                                                             \
  __VA_ARGS__ Sums<6> dot_six(const double* a, const double* b, std::size_t n) noexcept {       \
    return dots_of<BYTES, 6>(a, b, n);                                                          \
  }                                                                                             \
  __VA_ARGS__ Sums<9> moments(const double* a, const double* w, const double* x,                \
                              std::size_t n) noexcept {                                         \
    return moments_of<BYTES>(a, w, x, n);                                                       \
  }                                                                                             \
  __VA_ARGS__ Sums<9> cross_moments(const double* a, const double* b, const double* w,          \
                                    std::size_t n) noexcept {                                   \
    return cross_moments_of<BYTES>(a, b, w, n);                                                 \
  }                                                                                             \
  __VA_ARGS__ void add_ahead_single(const NodeRows<float>& rows, std::span<const double> x,     \
                                    double weight, const std::array<double*, 3>& y) noexcept {  \
    add_ahead_of<BYTES>(rows, x, weight, y);                                                    \
  }                                                                                             \
  __VA_ARGS__ void add_ahead_double(const NodeRows<double>& rows, std::span<const double> x,    \
                                    double weight, const std::array<double*, 3>& y) noexcept {  \
    add_ahead_of<BYTES>(rows, x, weight, y);                                                    \
  }                                                                                             \
  __VA_ARGS__ void add_effect_single(const NodeColumns<float>& columns,                         \
                                     const std::array<double, 3>& force,                        \
                                     const std::array<double*, 3>& y, std::size_t n) noexcept { \
    add_effect_of<BYTES>(columns, force, y, n);                                                 \
  }                                                                                             \
  __VA_ARGS__ void add_effect_double(const NodeColumns<double>& columns,                        \
                                     const std::array<double, 3>& force,                        \
                                     const std::array<double*, 3>& y, std::size_t n) noexcept { \
    add_effect_of<BYTES>(columns, force, y, n);                                                 \
  }                                                                                             \
  constexpr WideKernels kSet{dot_three,         dot_six,          moments,                      \
                             cross_moments,     add_ahead_single, add_ahead_double,             \
                             add_effect_single, add_effect_double};                             \
  }

IRDM_WIDE_KERNELS(portable, 16)
#ifdef IRDM_CHOOSES_KERNELS
IRDM_WIDE_KERNELS(avx2, 32, __attribute__((target("avx2"))))
IRDM_WIDE_KERNELS(avx512, 64, __attribute__((target("avx512f"))))
#endif
#undef IRDM_WIDE_KERNELS

// Best first.
#ifdef IRDM_CHOOSES_KERNELS
constexpr std::array kSets{avx512::kSet, avx2::kSet, portable::kSet};

std::size_t best_set() noexcept {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) return 0;
  return __builtin_cpu_supports("avx2") ? 1 : 2;
}
#else
constexpr std::array kSets{portable::kSet};

std::size_t best_set() noexcept {
  return 0;
}
#endif

const WideKernels kWideKernels = kSets[best_set()];

}  // namespace

std::span<const WideKernels> wide_kernels() noexcept {
  return std::span(kSets).subspan(best_set());
}

Sums<3> dot_three(const double* a, const double* b, std::size_t n) noexcept {
  return kWideKernels.dot_three(a, b, n);
}
Sums<6> dot_six(const double* a, const double* b, std::size_t n) noexcept {
  return kWideKernels.dot_six(a, b, n);
}
Sums<9> moments(const double* a, const double* w, const double* x, std::size_t n) noexcept {
  return kWideKernels.moments(a, w, x, n);
}
Sums<9> cross_moments(const double* a, const double* b, const double* w, std::size_t n) noexcept {
  return kWideKernels.cross_moments(a, b, w, n);
}
void add_ahead(const NodeRows<float>& rows, std::span<const double> x, double weight,
               const std::array<double*, 3>& y) noexcept {
  kWideKernels.add_ahead_single(rows, x, weight, y);
}
void add_ahead(const NodeRows<double>& rows, std::span<const double> x, double weight,
               const std::array<double*, 3>& y) noexcept {
  kWideKernels.add_ahead_double(rows, x, weight, y);
}
void add_effect(const NodeColumns<float>& columns, const std::array<double, 3>& force,
                const std::array<double*, 3>& y, std::size_t n) noexcept {
  kWideKernels.add_effect_single(columns, force, y, n);
}
void add_effect(const NodeColumns<double>& columns, const std::array<double, 3>& force,
                const std::array<double*, 3>& y, std::size_t n) noexcept {
  kWideKernels.add_effect_double(columns, force, y, n);
}

}  // namespace irdm
