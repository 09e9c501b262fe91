#pragma once

#include <cstdint>
#include <optional>

#include "common/stylus.hpp"
#include "device_bridge/contact/bridge_contact.hpp"
#include "device_bridge/haptic_device.hpp"
#include "device_bridge/safety/safety_filter.hpp"
#include "device_bridge/servo_link.hpp"
#include "device_bridge/workspace.hpp"

namespace irdm {

/// How a device takes part in W.
struct DeviceMapping {
  Workspace workspace = {};
  ButtonMap buttons = {};
};

/// One stylus of the servo loop: device (D) through workspace and clutch to sample (W), and force
/// and torque (W) through workspace, clutch and safety filter to device (D). Knows no thread, clock
/// or socket; nothing in it allocates or throws.
/// Large: each stage between device and sample is a member; the order among them is this class.
class ServoLoop {
 public:
  /// @param limits of force and torque at the device
  /// @param arm_by_button whenever the filter would arm, it waits until a button of the device goes
  /// down; false: it arms by itself
  ServoLoop(HapticDevice& device, const FilterLimits& limits, const DeviceMapping& mapping = {},
            bool arm_by_button = false);

  /// Begins a session of the device's time: samples are numbered from 0 again, the clutch's
  /// offset is gone, and the filter is to arm.
  /// @param link_matters false: at once, however good the link is
  void restart(bool link_matters = false) noexcept;

  /// From here on the contact is solved here, from the server's models; until restart() or hold().
  /// @param dt of the server's step [s]  @param tick_ns between two ticks
  void predict(double dt, std::int64_t tick_ns) noexcept {
    hold();
    contact_.emplace(dt, tick_ns);
  }
  /// From here on the server's forces are shown as they come.
  void hold() noexcept {
    withheld_ = withheld();
    contact_.reset();
  }

  /// Reads the device.
  /// @param device_time as for HapticDevice::read() [s]
  void read(double device_time) noexcept;
  /// What was read last, as a sample with the next number.
  /// @param now_ns goes into the sample, and comes back with the force that answers it
  StylusSample take_sample(std::int64_t now_ns) noexcept;
  /// The one that was taken last.
  const StylusSample& sample() const noexcept { return sample_; }

  /// Where the contact is solved here, else nothing happens.
  /// @param model has passed check()
  void receive(const ContactModel& model, std::int64_t now_ns) noexcept;
  /// The same. Ends the steps that are due, with the stylus where it was read last.
  void end_steps(std::int64_t now_ns) noexcept;
  /// After apply(): what is news for the server of the steps that ended; null when there is none.
  const AppliedForces* applied() const noexcept {
    return contact_ && steps_ended_ ? &contact_->applied() : nullptr;
  }

  /// Shows what the filter makes of the force; none before the first read(). What it shows of a
  /// force that was solved here is what the object gets.
  /// @param now_ns the clock that samples are stamped with
  void apply(std::int64_t now_ns, const ServoInput& input) noexcept;
  /// Shows no force.
  void rest() noexcept { show({}); }

  /// A tick without a session: reads the device, so that its driver and its state go on, and shows
  /// no force.
  void idle(double device_time) noexcept {
    read(device_time);
    rest();
  }

  /// There is no force because a button was not pressed yet.
  bool awaits_button() const noexcept { return awaits_button_; }

  const FilterLimits& limits() const noexcept { return limits_; }
  const SafetyFilter& filter() const noexcept { return filter_; }
  double peak_force() const noexcept { return peak_force_; }    ///< shown so far [N], D
  double impulse() const noexcept { return impulse_; }          ///< of its magnitude, so far [N s]
  double peak_torque() const noexcept { return peak_torque_; }  ///< shown so far [N m], D
  /// Of all sessions.
  FilterCounts counts() const noexcept;
  /// BridgeContact::withheld(), of all sessions.
  std::uint64_t withheld() const noexcept {
    return withheld_ + (contact_ ? contact_->withheld() : 0);
  }
  HapticDevice& device() noexcept { return device_; }
  /// Tip as it was read last, not a number if of no use [m], D.
  Vector3 reading() const noexcept { return reading_.value_or(pose_.tip); }
  /// Buttons as they were read last, the device's own bits.
  std::uint32_t device_buttons() const noexcept { return device_buttons_; }
  /// What was asked for last, and the force [N] and torque [N m] that were shown, D.
  const ForceDemand& demanded() const noexcept { return demanded_; }
  const Vector3& shown() const noexcept { return shown_.force; }
  const Vector3& shown_torque() const noexcept { return shown_.torque; }
  /// As of the last read().
  const DeviceState& device_state() const noexcept { return device_state_; }

 private:
  void report_shown() noexcept;
  ForceDemand demand(std::int64_t now_ns, const ServoInput& input) noexcept;
  void update_device_state() noexcept;
  void arm() noexcept;
  void show(const Wrench& wrench) noexcept {
    shown_ = wrench;
    device_.write(wrench);
  }

  HapticDevice& device_;
  FilterLimits limits_;
  DeviceMapping mapping_;
  SafetyFilter filter_;
  Clutch clutch_;
  std::optional<BridgeContact> contact_;  ///< none: the server's forces are held
  bool steps_ended_ = false;              ///< in this tick
  StylusPose pose_;                       ///< the last good one, W; buttons as on the wire
  /// Tip as it was read last, not a number if of no use; none since restart() [m], D.
  std::optional<Vector3> reading_;
  Quaternion orientation_ = Quaternion::Identity();  ///< the last good one, D
  std::uint32_t device_buttons_ = 0;                 ///< as they were read last
  bool arm_by_button_;
  bool awaits_button_ = false;
  bool pressed_ = false;  ///< a button went down with the last read(), which was not the first
  ForceDemand demanded_;
  Wrench shown_;
  DeviceState device_state_;
  bool was_ready_ = true;
  std::uint64_t next_sequence_ = 0;
  StylusSample sample_;  ///< that was taken last
  double peak_force_ = 0.0;
  double impulse_ = 0.0;
  double peak_torque_ = 0.0;
  std::optional<std::int64_t> applied_ns_;  ///< time of the last apply() since restart()
  FilterCounts counts_;                     ///< of the sessions before; and the next
  std::uint64_t withheld_ = 0;
};

}  // namespace irdm
