#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace irdm {

/// What modes do in the coming steps without a force, a course each:
/// x[s + 1] = trace x[s] - determinant x[s - 1], of the transition A of a mode (Cayley and
/// Hamilton).
struct Courses {
  const double* trace;
  const double* determinant;
  double* now;   ///< x[0]; goes on to the step after the last one
  double* next;  ///< x[1]; the same
};

/// Steps at a time, whose sums fit into registers.
inline constexpr std::size_t kCourse = 3;
/// Modes at a time of the widest registers.
inline constexpr std::size_t kCourseLanes = 8;

/// sums[s][k] += sum_i weights[k][i] x_i[s] over n modes. Products and sums are fused, which rounds
/// less and takes half the time; where a processor cannot do that, the last bits differ. Real-time
/// safe.
/// @param weights (3, stride)  @param n multiple of kCourseLanes
/// @param sums of the steps, a multiple of kCourse
using AddCourses = void (*)(const Courses& courses, const double* weights, std::size_t stride,
                            std::size_t n, std::span<std::array<double, 3>> sums) noexcept;

/// All that this processor can run, the best first.
std::span<const AddCourses> course_kernels() noexcept;

}  // namespace irdm
