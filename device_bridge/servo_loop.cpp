#include "device_bridge/servo_loop.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/realtime/clock.hpp"

namespace irdm {

ServoLoop::ServoLoop(HapticDevice& device, const FilterLimits& limits, const DeviceMapping& mapping,
                     bool arm_by_button)
    : device_(device),
      limits_(limits),
      mapping_(mapping),
      filter_(limits),
      arm_by_button_(arm_by_button) {
  arm();
}

void ServoLoop::arm() noexcept {
  awaits_button_ = arm_by_button_;
  if (!arm_by_button_) filter_.arm();
}

void ServoLoop::restart(bool link_matters) noexcept {
  counts_ = counts();
  FilterLimits limits = limits_;
  if (!link_matters) limits.needed_success = 0.0;
  filter_ = SafetyFilter(limits);
  arm();
  clutch_ = Clutch{};
  hold();
  reading_.reset();
  applied_ns_.reset();
  demanded_ = ForceDemand{};
  was_ready_ = true;
  next_sequence_ = 0;
}

void ServoLoop::read(double device_time) noexcept {
  const StylusPose pose = device_.read(device_time);
  const bool finite = pose.tip.allFinite() && pose.orientation.coeffs().allFinite();
  device_state_ = device_.state();
  pressed_ = reading_ && (pose.buttons & ~device_buttons_) != 0;
  device_buttons_ = pose.buttons;
  reading_ = finite ? pose.tip : Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  if (!finite) return;
  orientation_ = pose.orientation;
  pose_ = mapping_.workspace.to_world(pose);
  pose_.tip = clutch_.move(pose_.tip, mapping_.buttons.clutched(pose.buttons));
  pose_.buttons = mapping_.buttons.to_wire(pose.buttons);
}

StylusSample ServoLoop::take_sample(std::int64_t now_ns) noexcept {
  sample_ = {.sequence = next_sequence_++,
             .time_ns = now_ns,
             .buttons = pose_.buttons,
             .tip = pose_.tip,
             .orientation = pose_.orientation};
  return sample_;
}

void ServoLoop::receive(const ContactModel& model, std::int64_t now_ns) noexcept {
  if (contact_) contact_->receive(model, now_ns);
}

void ServoLoop::end_steps(std::int64_t now_ns) noexcept {
  steps_ended_ = contact_ && contact_->tick(now_ns, pose_.tip);
}

void ServoLoop::report_shown() noexcept {
  if (contact_) contact_->shown(mapping_.workspace.force_to_world(shown_.force));
}

// Force, torque and normal in W. The server's torque is that of a tool, which only the server's
// steps know: a contact that is solved here has none.
ForceDemand ServoLoop::demand(std::int64_t now_ns, const ServoInput& input) noexcept {
  if (!contact_) {
    const StylusForce& newest = input.force;
    return {.linked = input.linked,
            .any = input.any_force,
            .sample_time_ns = input.ageless ? now_ns : newest.sample_time_ns,
            .contact = newest.contact,
            .force = newest.force,
            .torque = newest.torque};
  }
  const BridgeContact::ForceCommand& wanted = contact_->wanted();
  return {.linked = input.linked && !wanted.paused,
          .any = wanted.any,
          .sample_time_ns = std::min(wanted.content_ns, now_ns),
          .horizon_ns = wanted.horizon_ns,
          .solved_here = true,
          .solved_ns = wanted.solved_ns,
          .energy = wanted.energy,
          .contact = wanted.contact,
          .force = wanted.force,
          .normal = wanted.normal};
}

// What is not ready gets no force, and afterwards it comes back as after an arm action.
void ServoLoop::update_device_state() noexcept {
  const FilterState state = filter_.state();
  const bool was_ready = std::exchange(was_ready_, device_state_.ready);
  if (state == FilterState::kFault) return;
  if (device_state_.failed) {
    if (state != FilterState::kDisarmed || filter_.waits()) filter_.fail();
  } else if (!device_state_.ready) {
    filter_.disarm();
  } else if (!was_ready) {
    arm();
  } else if (awaits_button_ && pressed_) {
    awaits_button_ = false;
    filter_.arm();
  }
}

void ServoLoop::apply(std::int64_t now_ns, const ServoInput& input) noexcept {
  if (!reading_) {
    rest();
    if (contact_) contact_->shown(Vector3::Zero());
    return;
  }
  update_device_state();
  ForceDemand wanted = demand(now_ns, input);
  const double gain = clutch_.gain(now_ns);
  wanted.force = gain * mapping_.workspace.to_device(wanted.force);
  wanted.torque = gain * mapping_.workspace.torque_to_device(wanted.torque);
  wanted.energy *= mapping_.workspace.force_scale / mapping_.workspace.scale;
  wanted.normal = mapping_.workspace.direction_to_device(wanted.normal);
  const Wrench wrench = filter_.step(now_ns,
                                     {.tip = *reading_,
                                      .orientation = orientation_,
                                      .motor_temperature = device_state_.motor_temperature,
                                      .repeated = device_state_.repeated,
                                      .saturated = device_state_.saturated,
                                      .off = device_state_.off},
                                     wanted);
  demanded_ = wanted;
  if (applied_ns_) {
    constexpr std::int64_t kLongest = 50'000'000;
    const auto held_ns = std::clamp<std::int64_t>(now_ns - *applied_ns_, 0, kLongest);
    impulse_ += kNanosecond * static_cast<double>(held_ns) * shown_.force.norm();
  }
  applied_ns_ = now_ns;
  peak_force_ = std::max(peak_force_, wrench.force.norm());
  peak_torque_ = std::max(peak_torque_, wrench.torque.norm());
  show(wrench);
  report_shown();
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
