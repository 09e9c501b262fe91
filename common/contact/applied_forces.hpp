#pragma once

#include <array>
#include <cstdint>

#include "common/geometry.hpp"

namespace irdm {

/// What one stylus did in one step, where its bridge solves the contact.
struct AppliedForce {
  Vector3 force = Vector3::Zero();  ///< on the object [N], W
  Vector3 tip = Vector3::Zero();    ///< at the end of the step [m], W
  Vector3 arm = Vector3::Zero();    ///< from the centre of mass to where it acted [m], B
};

/// No hand pushes harder [N].
inline constexpr double kMostAppliedForce = 100.0;

/// A force [N], no larger than that, whatever was found or told.
inline Vector3 bounded_force(const Vector3& force) noexcept {
  const double norm = force.norm();
  return norm > kMostAppliedForce ? Vector3(kMostAppliedForce / norm * force) : force;
}

/// The last steps of such a stylus: each is told several times, so that what is lost on the way
/// comes with the next.
struct AppliedForces {
  static constexpr int kSteps = 16;

  std::uint64_t step = 0;                 ///< the newest
  std::uint64_t base = 0;                 ///< step of the contact model that the newest rests on
  int count = 0;                          ///< how many there are, 0 to kSteps, at most step + 1
  std::array<AppliedForce, kSteps> past;  ///< past[i] of step - i; the first `count`
};

}  // namespace irdm
