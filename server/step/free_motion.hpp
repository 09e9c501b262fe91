#pragma once

#include "common/geometry.hpp"

namespace irdm {

/// Where everything but the contacts takes the body frame by the end of a step.
struct FreeMotion {
  Vector3 force = Vector3::Zero();                  ///< of gravity, damping, tether [N], W
  Vector3 torque = Vector3::Zero();                 ///< about the centre of mass [N m], W
  Vector3 position = Vector3::Zero();               ///< c + dt v_free [m], W
  Quaternion orientation = Quaternion::Identity();  ///< exp(dt w_free) Q

  /// A point of W in that frame.
  Vector3 to_body(const Vector3& x) const noexcept {
    return orientation.conjugate() * (x - position);
  }
  /// A point of that frame in W.
  Vector3 to_world(const Vector3& x) const noexcept { return position + orientation * x; }
};

}  // namespace irdm
