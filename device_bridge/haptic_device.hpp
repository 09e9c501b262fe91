#pragma once

#include <functional>
#include <limits>
#include <string>

#include "common/motion/wrench.hpp"
#include "device_bridge/stylus_script.hpp"

namespace irdm {

/// Makes the ticks of the servo loop where the driver of a device makes them itself, on a thread of
/// its own, and takes forces only inside them.
class TickSource {
 public:
  TickSource() = default;
  TickSource(const TickSource&) = delete;
  TickSource& operator=(const TickSource&) = delete;
  virtual ~TickSource() = default;

  /// From now on calls `tick` about `rate` times a second, until it returns false or stop(). Throws
  /// Error when the driver cannot.
  /// @param rate [Hz]
  /// @param tick real-time safe, does not throw; never called twice at a time
  virtual void start(double rate, std::function<bool()> tick) = 0;
  /// When it returns, no tick is under way and none comes any more.
  virtual void stop() noexcept = 0;
};

/// What a device says of itself beside its readings.
struct DeviceState {
  double motor_temperature = 0.0;  ///< of the warmest motor, 0 cold to 1; 0: it says nothing
  bool ready = true;               ///< calibrated; while it is not, no force
  bool failed = false;             ///< something went wrong: no force any more
  bool lost = false;               ///< and no readings either
  bool repeated = false;           ///< the reading is that of a moment ago, nothing newer
  bool saturated = false;          ///< the motors show less than the last write() asked for
  bool off = false;                ///< they show nothing, whatever it asked for
};

/// Noise of a position hides steps of so many times its standard deviation.
inline constexpr double kNoiseSteps = 4.0;

/// What a device is made for: its largest forces and torques, where infinity says nothing of them.
struct DeviceRating {
  double peak = std::numeric_limits<double>::infinity();        ///< [N], > 0
  double continuous = std::numeric_limits<double>::infinity();  ///< for ever [N], > 0
  double peak_torque = 0.0;                                     ///< [N m]; 0: it renders no torque
  double continuous_torque = std::numeric_limits<double>::infinity();  ///< for ever [N m], > 0
  double resolution = 0.0;  ///< of the tip's position [m]; 0: it does not say
};

/// A force-feedback stylus, in its own frame D; the servo loop knows where D lies in W. Made and
/// opened at start-up, then used by the servo thread alone: once a tick read() and then write().
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

  /// The stylus now, in D; its buttons are the device's own bits (ButtonMap). What is not finite is
  /// of no use. Real-time safe.
  /// @param time since the session began, does not decrease; 0 before [s]
  virtual StylusPose read(double time) noexcept = 0;
  /// Shows this on the stylus until the next call: the force at its tip and, where the device
  /// renders torque, the torque about the tip; D. Real-time safe.
  virtual void write(const Wrench& shown) noexcept = 0;
  /// As of the last read() and write(). Real-time safe.
  virtual DeviceState state() const noexcept { return {}; }

  /// Whether its time is ours to say, so that it can run in lockstep.
  virtual bool simulated() const noexcept = 0;
  /// Time after which nothing more comes from it [s]; infinity for a person's hand.
  virtual double duration() const noexcept = 0;
  /// What it bears and tells; after open().
  virtual DeviceRating rating() const noexcept { return {}; }
  /// Model and number, by which it is known again; after open(). Empty: it does not say.
  virtual std::string identity() const { return {}; }
  /// Whose ticks read() and write() belong to; nullptr: anybody's. Lives as long as the device.
  virtual TickSource* tick_source() noexcept { return nullptr; }
  /// What is wrong with it now and what to do, for a person; empty: nothing. Any thread.
  virtual std::string trouble() const { return {}; }
};

}  // namespace irdm
