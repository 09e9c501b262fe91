#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "device_bridge/haptic_device.hpp"
#include "device_bridge/virtual_hand.hpp"
#include "device_bridge/virtual_motors.hpp"
#include "device_bridge/virtual_sensor.hpp"

namespace irdm {

struct DeviceConfig;

/// A stylus without hardware: it moves as scripted, or is held by a simulated hand that follows the
/// script and feels what the motors show of the force. Orientation and buttons are always those of
/// the script.
class VirtualStylus : public HapticDevice {
 public:
  explicit VirtualStylus(StylusScript script, const std::optional<HandParameters>& hand = {},
                         const SensorParameters& sensor = {}, const MotorParameters& motors = {});

  void open() override {}
  void close() noexcept override {}
  StylusPose read(double time) noexcept override;
  void write(const Vector3& force) noexcept override { motors_.set(force); }
  DeviceState state() const noexcept override;
  bool simulated() const noexcept override { return true; }
  double duration() const noexcept override { return script_.end(); }
  ForceRating rating() const noexcept override { return rating_; }
  std::string trouble() const override;

 private:
  Vector3 move_hand(double time, const Vector3& target) noexcept;

  StylusScript script_;
  std::optional<VirtualHand> hand_;
  VirtualSensor sensor_;
  VirtualMotors motors_;
  ForceRating rating_;
  double time_ = 0.0;
  std::atomic<bool> warm_{false};
};

/// For the registry: loads the script that the configuration names. Throws Error.
std::unique_ptr<HapticDevice> make_virtual_stylus(const DeviceConfig& config);

}  // namespace irdm
