#include "device_bridge/force_guard.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {

double ForceGuard::fade(std::int64_t now_ns) const noexcept {
  std::int64_t age_ns = now_ns - held_.sample_time_ns;
  if (age_ns < 0) return 0.0;  // a sample of the future: not one of ours
  if (lost_since_ns_) age_ns = std::max(age_ns, limits_.hold_ns + now_ns - *lost_since_ns_);
  const double over = static_cast<double>(age_ns - limits_.hold_ns);
  return std::clamp(1.0 - over / static_cast<double>(limits_.fade_ns), 0.0, 1.0);
}

Vector3 ForceGuard::apply(std::int64_t now_ns, const ServoInput& input) noexcept {
  if (input.linked && input.any_force) {
    held_ = input.force;
    lost_since_ns_.reset();
  } else if (!input.linked && !lost_since_ns_) {
    lost_since_ns_ = now_ns;
  }
  const double elapsed = static_cast<double>(now_ns - last_ns_.value_or(now_ns));
  last_ns_ = now_ns;
  gain_ = std::min(gain_ + elapsed / static_cast<double>(limits_.fade_ns), fade(now_ns));

  const double magnitude = held_.force.stableNorm();
  if (!held_.force.allFinite() || !std::isfinite(magnitude)) {
    ++faults_;
    gain_ = 0.0;
    return Vector3::Zero();
  }
  const double shortening = magnitude > limits_.max_force ? limits_.max_force / magnitude : 1.0;
  return gain_ * shortening * held_.force;
}

}  // namespace irdm
