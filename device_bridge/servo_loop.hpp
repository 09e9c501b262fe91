#pragma once

#include <cstdint>

#include "common/stylus.hpp"
#include "device_bridge/force_guard.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm {

/// One stylus of the servo loop: device to sample, and force through the guard to device. Knows no
/// thread, clock or socket; nothing in it allocates or throws.
class ServoLoop {
 public:
  ServoLoop(HapticDevice& device, const GuardLimits& limits);

  /// Begins a session of the device's time: samples are numbered from 0 again.
  void restart() noexcept;

  /// Reads the device.
  /// @param device_time as for HapticDevice::read() [s]
  void read(double device_time) noexcept;
  /// What was read last, as a sample with the next number.
  /// @param now_ns goes into the sample, and comes back with the force that answers it
  StylusSample take_sample(std::int64_t now_ns) noexcept;

  /// Shows the force that the guard lets through.
  /// @param now_ns the clock that samples are stamped with
  void apply(std::int64_t now_ns, const ServoInput& input) noexcept;
  /// Shows no force.
  void rest() noexcept { device_.write(Vector3::Zero()); }

  double peak_force() const noexcept { return peak_force_; }  ///< shown so far [N]
  std::uint64_t faults() const noexcept { return faults_ + guard_.faults(); }
  HapticDevice& device() noexcept { return device_; }

 private:
  HapticDevice& device_;
  GuardLimits limits_;
  ForceGuard guard_;
  StylusPose pose_;
  std::uint64_t next_sequence_ = 0;
  double peak_force_ = 0.0;
  std::uint64_t faults_ = 0;
};

}  // namespace irdm
