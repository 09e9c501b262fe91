#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "device_bridge/forcedimension/dhd_api.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm {

struct DeviceConfig;

/// A device of Force Dimension (Omega, Delta, Sigma, Lambda) or a Falcon; it renders torque where
/// its wrist is active. D has its origin where the driver has it, +x right, +y up, +z towards the
/// person, as for OpenHaptics. The ticks are the servo thread's.
///
/// The device turns its force off by itself (the person's button, a hand that is too fast, a host
/// that is silent), and has none before it is initialised: it is not ready then, and the force
/// comes back as after arming. What the driver's watchdog or velocity limit turned off is turned on
/// again after a pause without force; a button is the person's to press again.
class ForceDimensionDevice : public HapticDevice {
 public:
  /// @param name the driver's number of the device, "0" to "9", or its serial number, of two or
  /// more digits; empty: the first that is free
  /// @param auto_init the arm may move by itself to be initialised
  ForceDimensionDevice(std::string name, const dhd::Api& api, bool auto_init = false);
  ~ForceDimensionDevice() override { close(); }

  /// Throws Error for a name that is no number, and for a device that is open already, too.
  void open() override;
  void close() noexcept override;
  StylusPose read(double time) noexcept override;
  void write(const Wrench& shown) noexcept override;
  DeviceState state() const noexcept override;
  bool simulated() const noexcept override { return false; }
  double duration() const noexcept override { return std::numeric_limits<double>::infinity(); }
  DeviceRating rating() const noexcept override { return rating_; }
  std::string identity() const override { return identity_; }
  std::string trouble() const override;

 private:
  static constexpr int kClosed = -1;

  int open_by_name() const;
  [[noreturn]] void fail(const std::string& what) const;
  void prepare();
  void initialise(bool initialised);
  void look() noexcept;
  void count(bool failed, int& in_a_row) noexcept;
  std::string label() const;

  std::string name_;
  const dhd::Api& dhd_;
  bool auto_init_;
  int id_ = kClosed;
  int type_ = 0;  ///< the driver's number of the model
  DeviceRating rating_;
  std::string identity_;
  StylusPose pose_;  ///< that was read last
  bool repeated_ = false;
  bool cut_off_ = false;  ///< the last force was, or was not taken
  int ticks_ = 0;         ///< since the status was asked for
  int pause_ = 0;         ///< statuses left until the force is turned on again
  int failures_ = 0;      ///< readings in a row
  int refusals_ = 0;      ///< forces in a row
  std::uint64_t repeats_ = 0, refused_ = 0, saturated_ = 0;  ///< so far
  std::atomic<bool> initialised_{false};
  std::atomic<dhd::ForceOff> cause_{dhd::ForceOff::kNone};
  std::atomic<bool> force_on_{false};
  std::atomic<bool> lost_{false};
};

/// For the registry: loads the driver. Throws Error that says what of it is missing.
std::unique_ptr<HapticDevice> make_forcedimension_device(const DeviceConfig& config);

}  // namespace irdm
