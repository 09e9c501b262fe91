#include "device_bridge/servo_loop.hpp"

#include <algorithm>

namespace irdm {

ServoLoop::ServoLoop(HapticDevice& device, const GuardLimits& limits, const DeviceMapping& mapping)
    : device_(device), limits_(limits), mapping_(mapping), guard_(limits) {}

void ServoLoop::restart() noexcept {
  faults_ += guard_.faults();
  guard_ = ForceGuard(limits_);
  clutch_ = Clutch{};
  next_sequence_ = 0;
}

void ServoLoop::read(double device_time) noexcept {
  const StylusPose pose = device_.read(device_time);
  if (!pose.tip.allFinite() || !pose.orientation.coeffs().allFinite()) {
    ++faults_;  // the last good one stays
    return;
  }
  pose_ = mapping_.workspace.to_world(pose);
  pose_.tip = clutch_.move(pose_.tip, mapping_.buttons.clutched(pose.buttons));
  pose_.buttons = mapping_.buttons.to_wire(pose.buttons);
}

StylusSample ServoLoop::take_sample(std::int64_t now_ns) noexcept {
  return {.sequence = next_sequence_++,
          .time_ns = now_ns,
          .buttons = pose_.buttons,
          .tip = pose_.tip,
          .orientation = pose_.orientation};
}

void ServoLoop::apply(std::int64_t now_ns, const ServoInput& input) noexcept {
  ServoInput at_device = input;
  at_device.force.force = mapping_.workspace.to_device(input.force.force);
  const Vector3 force = clutch_.gain(now_ns) * guard_.apply(now_ns, at_device);
  peak_force_ = std::max(peak_force_, force.norm());
  device_.write(force);
}

}  // namespace irdm
