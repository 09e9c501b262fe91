#include "device_bridge/servo_loop.hpp"

#include <algorithm>

namespace irdm {

ServoLoop::ServoLoop(HapticDevice& device, const GuardLimits& limits)
    : device_(device), limits_(limits), guard_(limits) {}

void ServoLoop::restart() noexcept {
  faults_ += guard_.faults();
  guard_ = ForceGuard(limits_);
  next_sequence_ = 0;
}

void ServoLoop::read(double device_time) noexcept {
  const StylusPose pose = device_.read(device_time);
  if (pose.tip.allFinite() && pose.orientation.coeffs().allFinite()) {
    pose_ = pose;
  } else {
    ++faults_;  // the last good one stays
  }
}

StylusSample ServoLoop::take_sample(std::int64_t now_ns) noexcept {
  return {.sequence = next_sequence_++,
          .time_ns = now_ns,
          .buttons = pose_.buttons,
          .tip = pose_.tip,
          .orientation = pose_.orientation};
}

void ServoLoop::apply(std::int64_t now_ns, const ServoInput& input) noexcept {
  const Vector3 force = guard_.apply(now_ns, input);
  peak_force_ = std::max(peak_force_, force.norm());
  device_.write(force);
}

}  // namespace irdm
