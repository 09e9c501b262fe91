#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/motion/wrench.hpp"

namespace irdm {

/// Velocity of a tip whose position comes in steps. A difference of two readings would be the
/// step over the tick, whenever an encoder counts, and damping by it would shake the hand. At rest,
/// where readings go to and fro within the resolution, it is zero; else the slope of the longest
/// line that ends at the last readings and is nowhere further from those between than the
/// resolution (Janabi-Sharifi, Hayward, Chen, IEEE Trans. Control Syst. Technol. 8(6), 2000, "first
/// order adaptive windowing", end-fit). Pure, real-time safe.
class VelocityEstimate {
 public:
  static constexpr std::size_t kLongest = 16;  ///< ticks that a line spans
  /// No velocity is told from a shorter time: two ticks can follow one another closely after a late
  /// one [s].
  static constexpr double kShortest = 5e-4;

  /// @param resolution [m]; 0: the difference of the last two readings
  explicit VelocityEstimate(double resolution) : resolution_(resolution) {}

  /// A good reading. Returns the velocity [m/s]; of the first one zero. Times do not go
  /// back.
  Vector3 next(std::int64_t time_ns, const Vector3& tip) noexcept;

 private:
  struct Reading {
    std::int64_t time_ns = 0;
    Vector3 tip = Vector3::Zero();
  };
  const Reading& back(std::size_t ticks) const noexcept;
  bool fits(const Vector3& velocity, std::size_t ticks) const noexcept;
  Vector3 slope(std::size_t ticks) const noexcept;

  double resolution_;
  std::array<Reading, kLongest + 1> readings_{};  ///< what is left of them within the resolution
  std::size_t count_ = 0;                         ///< of all so far
};

}  // namespace irdm
