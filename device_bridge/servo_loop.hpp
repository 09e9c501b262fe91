#pragma once

#include <cstdint>
#include <optional>

#include "common/stylus.hpp"
#include "device_bridge/button_map.hpp"
#include "device_bridge/clutch.hpp"
#include "device_bridge/haptic_device.hpp"
#include "device_bridge/safety/safety_filter.hpp"
#include "device_bridge/servo_input.hpp"
#include "device_bridge/workspace.hpp"

namespace irdm {

/// How a device takes part in W.
struct DeviceMapping {
  Workspace workspace = {};
  ButtonMap buttons = {};
};

/// One stylus of the servo loop: device (D) through workspace and clutch to sample (W), and force
/// (W) through workspace, clutch and safety filter to device (D). Knows no thread, clock or socket;
/// nothing in it allocates or throws.
class ServoLoop {
 public:
  /// @param limits of the force at the device
  ServoLoop(HapticDevice& device, const FilterLimits& limits, const DeviceMapping& mapping = {});

  /// Begins a session of the device's time: samples are numbered from 0 again, the clutch's
  /// offset is gone, and the filter is to arm.
  /// @param link_matters false: at once, however good the link is
  void restart(bool link_matters = false) noexcept;

  /// Reads the device.
  /// @param device_time as for HapticDevice::read() [s]
  void read(double device_time) noexcept;
  /// What was read last, as a sample with the next number.
  /// @param now_ns goes into the sample, and comes back with the force that answers it
  StylusSample take_sample(std::int64_t now_ns) noexcept;

  /// Shows what the filter makes of the force; none before the first read().
  /// @param now_ns the clock that samples are stamped with
  void apply(std::int64_t now_ns, const ServoInput& input) noexcept;
  /// Shows no force.
  void rest() noexcept { device_.write(Vector3::Zero()); }

  const FilterLimits& limits() const noexcept { return limits_; }
  const SafetyFilter& filter() const noexcept { return filter_; }
  double peak_force() const noexcept { return peak_force_; }  ///< shown so far [N], D
  /// Of all sessions.
  FilterCounts counts() const noexcept;
  HapticDevice& device() noexcept { return device_; }

 private:
  HapticDevice& device_;
  FilterLimits limits_;
  DeviceMapping mapping_;
  SafetyFilter filter_;
  Clutch clutch_;
  StylusPose pose_;  ///< the last good one, W; buttons as on the wire
  /// Tip as it was read last, not a number if of no use; none since restart() [m], D.
  std::optional<Vector3> reading_;
  std::uint64_t next_sequence_ = 0;
  double peak_force_ = 0.0;
  FilterCounts counts_;  ///< of the sessions before
};

}  // namespace irdm
