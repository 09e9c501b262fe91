#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "device_bridge/haptic_device.hpp"
#include "device_bridge/openhaptics/driver_warnings.hpp"
#include "device_bridge/openhaptics/hd_calibration.hpp"
#include "device_bridge/openhaptics/hd_error.hpp"
#include "device_bridge/openhaptics/openhaptics_scheduler.hpp"

namespace irdm {

struct DeviceConfig;

/// A device of 3D Systems (Touch, Phantom) by OpenHaptics' driver. D has its origin where the
/// driver has it, +x right, +y up, +z towards the person. One frame of the driver from read() to
/// write(), so that a force goes out in the tick of the position that it answers; with a torque
/// where the device has six actuated axes (Premium 6DOF). The driver's own limits stay on. What it
/// warns of, a calibration that is lost, or a force that it has turned off makes the device not
/// ready: the force comes back as after arming.
class OpenHapticsDevice : public HapticDevice {
 public:
  /// @param name by which the vendor's setup knows it; empty: the driver's default device
  OpenHapticsDevice(std::string name, std::shared_ptr<OpenHapticsScheduler> scheduler);
  ~OpenHapticsDevice() override { close(); }

  void open() override;
  void close() noexcept override;
  StylusPose read(double time) noexcept override;
  void write(const Wrench& shown) noexcept override;
  DeviceState state() const noexcept override;
  bool simulated() const noexcept override { return false; }
  double duration() const noexcept override { return std::numeric_limits<double>::infinity(); }
  DeviceRating rating() const noexcept override { return rating_; }
  std::string identity() const override { return identity_; }
  TickSource* tick_source() noexcept override { return scheduler_.get(); }
  std::string trouble() const override;

  hd::Handle handle() const noexcept { return handle_; }
  /// An error of the driver about this device. Real-time safe.
  void take(const hd::ErrorInfo& error) noexcept;

 private:
  void initialise();
  void turn_on();
  void read_rating();
  void begin_frame() noexcept;
  void look_at_calibration() noexcept;
  void warn(const hd::ErrorInfo& error) noexcept;
  void fail(const hd::ErrorInfo& error) noexcept;
  void count_tick() noexcept;
  void read_warmth() noexcept;
  std::string label() const;

  std::string name_;
  std::shared_ptr<OpenHapticsScheduler> scheduler_;
  const hd::Api& hd_;
  hd::Handle handle_ = hd::kInvalidHandle;
  hd::Calibration calibration_;
  bool calibrating_ = false;  ///< errors are about the calibration
  hd::DriverWarnings warnings_;
  DeviceRating rating_;
  std::string identity_;
  DeviceState state_;
  bool tells_warmth_ = true;
  std::int64_t warm_ns_ = 0;  ///< what is left of a warning of warm motors
  bool bad_frame_ = false;    ///< the next reading is of no use
  bool in_frame_ = false;
  bool shows_force_ = false;           ///< the last frame had a force or torque
  std::atomic<bool> output_on_{true};  ///< the driver shows forces
  // For trouble(): code and internal number.
  std::atomic<std::uint64_t> warned_{0};  ///< whose pause lasts
  std::atomic<std::uint64_t> fault_{0};   ///< first error that took the force
};

/// For the registry: loads the driver. Throws Error that says what of it is missing.
std::unique_ptr<HapticDevice> make_openhaptics_device(const DeviceConfig& config);

}  // namespace irdm
