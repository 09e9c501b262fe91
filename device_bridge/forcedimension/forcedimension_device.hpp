#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "device_bridge/forcedimension/dhd_api.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm {

struct DeviceConfig;

/// A device of Force Dimension (Omega, Delta, Sigma, Lambda) or a Falcon; it renders torque where
/// its wrist is active. D has its origin where the driver has it, +x right, +y up, +z towards the
/// person, as for OpenHaptics. Its driver has no thread of its own: the ticks are the servo
/// thread's.
class ForceDimensionDevice : public HapticDevice {
 public:
  /// @param name the driver's number of the device, "0" to "9"; empty: the first that is free
  ForceDimensionDevice(std::string name, const dhd::Api& api);
  ~ForceDimensionDevice() override { close(); }

  /// Throws Error for a name that is no number, too.
  void open() override;
  void close() noexcept override;
  StylusPose read(double time) noexcept override;
  void write(const Wrench& shown) noexcept override;
  DeviceState state() const noexcept override;
  bool simulated() const noexcept override { return false; }
  double duration() const noexcept override { return std::numeric_limits<double>::infinity(); }
  ForceRating rating() const noexcept override { return rating_; }
  std::string trouble() const override;

 private:
  static constexpr int kClosed = -1;

  int open_by_name() const;
  void count(bool failed) noexcept;
  std::string label() const;

  std::string name_;
  const dhd::Api& dhd_;
  int id_ = kClosed;
  ForceRating rating_;
  int failures_ = 0;  ///< in a row
  std::atomic<bool> lost_{false};
};

/// For the registry: loads the driver. Throws Error that says what of it is missing.
std::unique_ptr<HapticDevice> make_forcedimension_device(const DeviceConfig& config);

}  // namespace irdm
