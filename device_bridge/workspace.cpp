#include "device_bridge/workspace.hpp"

namespace irdm {

Vector3 Workspace::to_world(const Vector3& point_D) const noexcept {
  return position + scale * (rotation * point_D);
}

StylusPose Workspace::to_world(const StylusPose& pose_D) const noexcept {
  return {to_world(pose_D.tip), (rotation * pose_D.orientation).normalized(), pose_D.buttons};
}

Vector3 Workspace::to_device(const Vector3& force_W) const noexcept {
  return force_scale * (rotation.conjugate() * force_W);
}

}  // namespace irdm
