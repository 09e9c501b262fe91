#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace irdm {

/// Sums over modes for eight steps at once: a course is what a mode does in them. Products and sums
/// are fused, which rounds less and takes half the time; where a processor cannot do that, the last
/// bits differ.
inline constexpr std::size_t kCourse = 8;
template <std::size_t K>
using CourseSums = std::array<std::array<double, kCourse>, K>;

struct CourseKernels {
  /// sums[k] += sum_i weights[k][i] (course of mode i); courses (n, kCourse), weights (K, n).
  void (*add_three)(const float* courses, const double* weights, std::size_t n,
                    CourseSums<3>& sums) noexcept;
  void (*add_six)(const float* courses, const double* weights, std::size_t n,
                  CourseSums<6>& sums) noexcept;
};

/// All sets that this processor can run, the best first.
std::span<const CourseKernels> course_kernels() noexcept;

}  // namespace irdm
