#include "device_bridge/servo_loop.hpp"

#include <algorithm>
#include <limits>

namespace irdm {

ServoLoop::ServoLoop(HapticDevice& device, const FilterLimits& limits, const DeviceMapping& mapping)
    : device_(device), limits_(limits), mapping_(mapping), filter_(limits) {
  filter_.arm();
}

void ServoLoop::restart(bool link_matters) noexcept {
  counts_ = counts();
  FilterLimits limits = limits_;
  if (!link_matters) limits.needed_success = 0.0;
  filter_ = SafetyFilter(limits);
  filter_.arm();
  clutch_ = Clutch{};
  reading_.reset();
  next_sequence_ = 0;
}

void ServoLoop::read(double device_time) noexcept {
  const StylusPose pose = device_.read(device_time);
  const bool finite = pose.tip.allFinite() && pose.orientation.coeffs().allFinite();
  reading_ = finite ? pose.tip : Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  if (!finite) return;
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
  if (!reading_) return rest();
  const StylusForce& newest = input.force;
  const Vector3 force =
      filter_.step(now_ns, {.tip = *reading_},
                   {.linked = input.linked,
                    .any = input.any_force,
                    .sample_time_ns = newest.sample_time_ns,
                    .contact = newest.contact,
                    .force = clutch_.gain(now_ns) * mapping_.workspace.to_device(newest.force)});
  peak_force_ = std::max(peak_force_, force.norm());
  device_.write(force);
}

FilterCounts ServoLoop::counts() const noexcept {
  FilterCounts sum = filter_.counts();
  sum.readings += counts_.readings;
  sum.demands += counts_.demands;
  sum.trips += counts_.trips;
  sum.faults += counts_.faults;
  return sum;
}

}  // namespace irdm
