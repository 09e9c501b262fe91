#pragma once

#include "common/geometry.hpp"
#include "device_bridge/stylus_script.hpp"

namespace irdm {

/// A force-feedback stylus, in its own frame D; the servo loop knows where D lies in W. Made and
/// opened at start-up, then used by the servo thread alone: once a tick read(), and write() when
/// the force changes.
class HapticDevice {
 public:
  HapticDevice() = default;
  HapticDevice(const HapticDevice&) = delete;
  HapticDevice& operator=(const HapticDevice&) = delete;
  virtual ~HapticDevice() = default;

  /// Connects to the hardware; its force is zero until the first write(). Throws Error.
  virtual void open() = 0;
  /// Turns the force off and lets go of the hardware.
  virtual void close() noexcept = 0;

  /// The stylus now, in D; its buttons are the device's own bits (ButtonMap). Real-time safe.
  /// @param time since the session began, does not decrease; 0 before [s]
  virtual StylusPose read(double time) noexcept = 0;
  /// Shows this force on the stylus until the next call [N], D. Real-time safe.
  virtual void write(const Vector3& force) noexcept = 0;

  /// Whether its time is ours to say, so that it can run in lockstep.
  virtual bool simulated() const noexcept = 0;
  /// Time after which nothing more comes from it [s]; infinity for a person's hand.
  virtual double duration() const noexcept = 0;
};

}  // namespace irdm
