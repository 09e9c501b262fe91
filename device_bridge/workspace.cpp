#include "device_bridge/workspace.hpp"

#include <algorithm>

namespace irdm {

// The tip rests in the reading that the button goes up in, too: neither edge moves it.
Vector3 Clutch::move(const Vector3& tip, bool down) noexcept {
  const bool was_down = down_;
  down_ = down;
  if (!down && !was_down) return tip + offset_;
  if (!was_down) held_ = tip + offset_;
  offset_ = held_ - tip;
  return held_;
}

double Clutch::gain(std::int64_t now_ns) noexcept {
  const double elapsed = static_cast<double>(now_ns - last_ns_.value_or(now_ns));
  last_ns_ = now_ns;
  const double change = elapsed / static_cast<double>(kFadeNs);
  gain_ = std::clamp(gain_ + (down_ ? -change : change), 0.0, 1.0);
  return gain_;
}

Vector3 Workspace::to_world(const Vector3& point_D) const noexcept {
  return position + scale * (rotation * point_D);
}

StylusPose Workspace::to_world(const StylusPose& pose_D) const noexcept {
  return {to_world(pose_D.tip), (rotation * pose_D.orientation).normalized(), pose_D.buttons};
}

Vector3 Workspace::to_device(const Vector3& force_W) const noexcept {
  return force_scale * (rotation.conjugate() * force_W);
}

Vector3 Workspace::torque_to_device(const Vector3& torque_W) const noexcept {
  return force_scale / scale * (rotation.conjugate() * torque_W);
}

Vector3 Workspace::force_to_world(const Vector3& force_D) const noexcept {
  return rotation * force_D / force_scale;
}

}  // namespace irdm
