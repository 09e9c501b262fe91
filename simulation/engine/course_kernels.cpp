// Compiled with -ffp-contract=fast: each product is fused with the sum that it goes into.
#include "simulation/engine/course_kernels.hpp"

#include <cstring>

#include "simulation/engine/kernel_lanes.hpp"

namespace irdm {
namespace {

// IRDM_COURSE_KERNEL(its namespace, attributes, width of a register [byte]). GCC 12 splits what
// fills a register unless the function itself has the attribute, so that there is no template for
// widths.
#define IRDM_COURSE_KERNEL(NAME, ATTRIBUTES, BYTES)                                      \
  namespace NAME {                                                                       \
  ATTRIBUTES void add(const Courses& courses, const double* weights, std::size_t stride, \
                      std::size_t n, std::span<std::array<double, 3>> sums) noexcept {   \
    using Lanes [[gnu::vector_size(BYTES)]] = double;                                    \
    constexpr std::size_t kEach = (BYTES) / sizeof(double);                              \
    static_assert(kCourseLanes % kEach == 0);                                            \
    for (std::size_t first = 0; first < sums.size(); first += kCourse) {                 \
      Lanes lanes[kCourse][3] = {};                                                      \
      for (std::size_t i = 0; i < n; i += kEach) {                                       \
        Lanes now, next, trace, determinant, weight[3];                                  \
        std::memcpy(&now, courses.now + i, sizeof now);                                  \
        std::memcpy(&next, courses.next + i, sizeof next);                               \
        std::memcpy(&trace, courses.trace + i, sizeof trace);                            \
        std::memcpy(&determinant, courses.determinant + i, sizeof determinant);          \
        for (std::size_t k = 0; k < 3; ++k) {                                            \
          std::memcpy(&weight[k], weights + k * stride + i, sizeof weight[k]);           \
        }                                                                                \
        for (std::size_t s = 0; s < kCourse; ++s) {                                      \
          for (std::size_t k = 0; k < 3; ++k) lanes[s][k] += weight[k] * now;            \
          const Lanes after = trace * next - determinant * now;                          \
          now = next;                                                                    \
          next = after;                                                                  \
        }                                                                                \
        std::memcpy(courses.now + i, &now, sizeof now);                                  \
        std::memcpy(courses.next + i, &next, sizeof next);                               \
      }                                                                                  \
      for (std::size_t s = 0; s < kCourse; ++s) {                                        \
        for (std::size_t k = 0; k < 3; ++k) {                                            \
          for (std::size_t l = 0; l < kEach; ++l) sums[first + s][k] += lanes[s][k][l];  \
        }                                                                                \
      }                                                                                  \
    }                                                                                    \
  }                                                                                      \
  }

IRDM_COURSE_KERNEL(portable, , 16)
#ifdef IRDM_CHOOSES_KERNELS
IRDM_COURSE_KERNEL(avx2, __attribute__((target("avx2,fma"))), 32)
IRDM_COURSE_KERNEL(avx512, __attribute__((target("avx512f"))), 64)
constexpr std::array<AddCourses, 3> kKernels{avx512::add, avx2::add, portable::add};

std::size_t best_kernel() noexcept {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) return 0;
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") ? 1 : 2;
}
#else
constexpr std::array<AddCourses, 1> kKernels{portable::add};

std::size_t best_kernel() noexcept {
  return 0;
}
#endif
#undef IRDM_COURSE_KERNEL

}  // namespace

std::span<const AddCourses> course_kernels() noexcept {
  static const std::size_t best = best_kernel();
  return std::span(kKernels).subspan(best);
}

}  // namespace irdm
