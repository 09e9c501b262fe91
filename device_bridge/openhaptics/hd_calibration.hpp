#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "device_bridge/openhaptics/hd_library.hpp"

namespace irdm::hd {

/// Calibration of a device: asked for some times a second, between its frames. A device that
/// calibrates itself goes on doing so while it moves: what it has found is taken over, and its
/// force stays. One with an inkwell is calibrated when the stylus is in it. Encoders are never
/// reset: that is right in the reset pose only, and before the scheduler runs.
class Calibration {
 public:
  static constexpr std::int64_t kPeriodNs = 200'000'000;  ///< from one look to the next

  explicit Calibration(const Api& api) : api_(api) {}

  /// Before the scheduler runs; the device is the current one.
  void choose_style() noexcept;
  /// Once a tick: whether it is time to look. Real-time safe.
  /// @param elapsed_ns since the last one
  bool due(std::int64_t elapsed_ns) noexcept { return (left_ns_ -= elapsed_ns) <= 0; }
  /// Of the current device, outside of a frame. What goes wrong is among the driver's errors.
  /// Real-time safe.
  void look() noexcept;
  /// The last look or update failed; the next one tries again. Real-time safe.
  void fail() noexcept { found_.store(kFailed, std::memory_order_relaxed); }

  /// Positions are right, so that a force may be shown.
  bool good() const noexcept;
  /// What a person is to do; empty: nothing. Any thread.
  std::string trouble() const;

 private:
  static constexpr Name kFailed = 0;

  const Api& api_;
  Name style_ = 0;            ///< the best that the device has
  std::int64_t left_ns_ = 0;  ///< to the next look
  std::atomic<Name> found_{kCalibrationOk};
};

}  // namespace irdm::hd
