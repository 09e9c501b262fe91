#pragma once

#include "common/geometry.hpp"

namespace irdm {

/// Force [N] and torque [N m] on a body at a point of it, both in one frame.
struct Wrench {
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();

  bool is_zero() const noexcept { return force.isZero(0.0) && torque.isZero(0.0); }
};

/// Velocity of that point [m/s] and angular velocity [rad/s]; or a small displacement [m] with its
/// rotation vector [rad]. In the wrench's frame.
struct Twist {
  Vector3 linear = Vector3::Zero();
  Vector3 angular = Vector3::Zero();
};

/// Power of the wrench [W], or its work over a small displacement [J].
inline double work(const Wrench& wrench, const Twist& twist) noexcept {
  return wrench.force.dot(twist.linear) + wrench.torque.dot(twist.angular);
}

}  // namespace irdm
