#pragma once

#include <algorithm>
#include <limits>
#include <string>

#include "common/realtime/triple_buffer.hpp"
#include "device_bridge/commission/obedient_hand.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm::commission {

/// The virtual device while it is commissioned: held by a simulated person instead of its script.
class GuidedStylus : public HapticDevice {
 public:
  /// @param hand none: the default one
  GuidedStylus(const std::optional<HandParameters>& hand, const SensorParameters& sensor,
               const MotorParameters& motors)
      : hand_(hand.value_or(HandParameters{})),
        sensor_(sensor),
        motors_(motors),
        rating_{.peak = motors.max_force, .continuous = motors.continuous_force} {}

  /// What the person does next; main thread.
  void ask(const Order& order) noexcept { orders_.put(order); }

  void open() override {}
  void close() noexcept override {}
  StylusPose read(double time) noexcept override;
  void write(const Wrench& shown) noexcept override { motors_.set(shown); }
  DeviceState state() const noexcept override {
    return {.motor_temperature = std::min(motors_.warmth(), 1.0)};
  }
  bool simulated() const noexcept override { return true; }
  double duration() const noexcept override { return std::numeric_limits<double>::infinity(); }
  DeviceRating rating() const noexcept override { return rating_; }
  std::string identity() const override { return "virtual stylus"; }

 private:
  TripleBuffer<Order> orders_;
  ObedientHand hand_;
  VirtualSensor sensor_;
  VirtualMotors motors_;
  DeviceRating rating_;
  double time_ = 0.0;
};

}  // namespace irdm::commission
