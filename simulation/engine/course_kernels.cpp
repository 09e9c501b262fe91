// Compiled with -ffp-contract=fast: each product is fused with the sum that it goes into.
#include "simulation/engine/course_kernels.hpp"

#include <array>
#include <cstring>

#include "simulation/engine/kernel_lanes.hpp"

namespace irdm {
namespace {

// IRDM_COURSE_KERNELS(name of the set, attributes, width of a register [byte], x as often as one
// holds it). Several modes at a time: no sum waits for the one before. GCC 12 splits what fills a
// register unless the function itself has the attribute, so that there is no template for widths.
#define IRDM_COURSE_KERNELS(NAME, ATTRIBUTES, BYTES, ...)                                 \
  namespace NAME {                                                                        \
  using Lanes [[gnu::vector_size(BYTES)]] = double;                                       \
  using Singles [[gnu::vector_size(BYTES / 2)]] = float;                                  \
  constexpr std::size_t kEach = (BYTES) / sizeof(double);                                 \
  constexpr std::size_t kParts = kCourse / kEach;                                         \
  template <std::size_t K>                                                                \
  ATTRIBUTES void add(const float* courses, const double* weights, std::size_t n,         \
                      CourseSums<K>& sums) noexcept {                                     \
    constexpr std::size_t kModes = K == 3 ? 2 : 1;                                        \
    Lanes lanes[kModes][K][kParts] = {};                                                  \
    const auto add_modes = [&](std::size_t i, std::size_t count) ATTRIBUTES {             \
      for (std::size_t m = 0; m < count; ++m) {                                           \
        Lanes course[kParts];                                                             \
        for (std::size_t p = 0; p < kParts; ++p) {                                        \
          Singles singles;                                                                \
          std::memcpy(&singles, courses + (i + m) * kCourse + p * kEach, sizeof singles); \
          course[p] = __builtin_convertvector(singles, Lanes);                            \
        }                                                                                 \
        for (std::size_t k = 0; k < K; ++k) {                                             \
          const double x = weights[k * n + i + m];                                        \
          const Lanes weight{__VA_ARGS__};                                                \
          for (std::size_t p = 0; p < kParts; ++p) lanes[m][k][p] += weight * course[p];  \
        }                                                                                 \
      }                                                                                   \
    };                                                                                    \
    std::size_t i = 0;                                                                    \
    for (; i + kModes <= n; i += kModes) add_modes(i, kModes);                            \
    if (i < n) add_modes(i, 1);                                                           \
    for (std::size_t k = 0; k < K; ++k) {                                                 \
      for (std::size_t p = 0; p < kParts; ++p) {                                          \
        Lanes sum;                                                                        \
        std::memcpy(&sum, sums[k].data() + p * kEach, sizeof sum);                        \
        for (std::size_t m = 0; m < kModes; ++m) sum += lanes[m][k][p];                   \
        std::memcpy(sums[k].data() + p * kEach, &sum, sizeof sum);                        \
      }                                                                                   \
    }                                                                                     \
  }                                                                                       \
  constexpr CourseKernels kSet{add<3>, add<6>};                                           \
  }

IRDM_COURSE_KERNELS(portable, , 16, x, x)
#ifdef IRDM_CHOOSES_KERNELS
IRDM_COURSE_KERNELS(avx2, __attribute__((target("avx2,fma"))), 32, x, x, x, x)
IRDM_COURSE_KERNELS(avx512, __attribute__((target("avx512f"))), 64, x, x, x, x, x, x, x, x)
constexpr std::array kSets{avx512::kSet, avx2::kSet, portable::kSet};

std::size_t best_set() noexcept {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) return 0;
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? 1 : 2;
}
#else
constexpr std::array kSets{portable::kSet};

std::size_t best_set() noexcept {
  return 0;
}
#endif
#undef IRDM_COURSE_KERNELS

}  // namespace

std::span<const CourseKernels> course_kernels() noexcept {
  static const std::size_t best = best_set();
  return std::span(kSets).subspan(best);
}

}  // namespace irdm
