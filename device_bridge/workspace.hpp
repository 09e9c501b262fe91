#pragma once

#include "common/geometry.hpp"
#include "device_bridge/stylus_script.hpp"

namespace irdm {

/// Where the frame D of a device lies in W: p_W = position + scale rotation p_D. Pure.
///
/// With v_W = scale R v_D and f_D = force_scale R^T f_W, what the device does to the hand is
/// f_D . v_D = (force_scale / scale) f_W . v_W: a fixed positive multiple of what happens in W. So
/// any positive pair keeps a passive world passive at the device; only its stiffness in the hand
/// changes, by force_scale times scale, and with it how soon a delayed loop becomes unstable.
struct Workspace {
  Vector3 position = Vector3::Zero();            ///< of D's origin [m], W
  Quaternion rotation = Quaternion::Identity();  ///< D to W, norm 1
  double scale = 1.0;                            ///< length in W per length in D, > 0
  double force_scale = 1.0;                      ///< force at the device per force in W, > 0

  /// A point of D [m] in W.
  Vector3 to_world(const Vector3& point_D) const noexcept;
  /// A pose in D in W; buttons stay.
  StylusPose to_world(const StylusPose& pose_D) const noexcept;
  /// A force in W as the device shows it [N], D.
  Vector3 to_device(const Vector3& force_W) const noexcept;
  /// A direction in W, in D.
  Vector3 direction_to_device(const Vector3& direction_W) const noexcept {
    return rotation.conjugate() * direction_W;
  }
};

}  // namespace irdm
