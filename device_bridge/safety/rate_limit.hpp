#pragma once

#include "common/geometry.hpp"

namespace irdm {

struct RateLimits {
  double rise = 300.0;      ///< of a force that does not become smaller [N/s]
  double fall = 1200.0;     ///< towards zero [N/s]
  double longest = 2.0e-3;  ///< what is more between two ticks does not count [s]
};

/// How far towards `to` a force may go from `from` [N]. One that becomes half as large or less goes
/// straight at the falling rate as long as that takes it nearer to zero; one that does not become
/// smaller goes at the rising rate, and so does what is left of a way; in between the rates blend.
/// So the magnitude never rises faster than `rise`, and nothing changes faster than `fall`; and a
/// wrong force that is larger than the one shown moves it by no more than `rise`, whatever its
/// direction. Pure.
/// @param elapsed since `from` was first shown [s]
Vector3 limit_rate(const Vector3& from, const Vector3& to, const RateLimits& limits,
                   double elapsed) noexcept;

}  // namespace irdm
