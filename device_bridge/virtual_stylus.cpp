#include "device_bridge/virtual_stylus.hpp"

#include <algorithm>
#include <utility>

#include "device_bridge/bridge_config.hpp"

namespace irdm {

VirtualStylus::VirtualStylus(StylusScript script, const std::optional<HandParameters>& hand,
                             const SensorParameters& sensor, const MotorParameters& motors)
    : script_(std::move(script)),
      sensor_(sensor),
      motors_(motors),
      rating_{.peak = motors.max_force, .continuous = motors.continuous_force} {
  if (hand) hand_.emplace(*hand, script_.at(0.0).tip);
}

StylusPose VirtualStylus::read(double time) noexcept {
  StylusPose pose = script_.at(time);
  if (hand_) pose.tip = move_hand(time, pose.tip);
  motors_.advance(std::max(0.0, time - time_));
  warm_.store(motors_.warmth() >= 1.0, std::memory_order_relaxed);
  time_ = time;
  pose.tip = sensor_.measure(pose.tip);
  return pose;
}

// The motors may go off on the way.
Vector3 VirtualStylus::move_hand(double time, const Vector3& target) noexcept {
  const double elapsed = time - time_;
  const double on = elapsed > 0.0 ? motors_.on_for(elapsed) : elapsed;
  if (on < elapsed) {
    hand_->advance(on, script_.at(time_ + on).tip, motors_.force());
    hand_->advance(elapsed - on, target, Vector3::Zero());
  } else {
    hand_->advance(elapsed, target, motors_.force());
  }
  return hand_->position();
}

DeviceState VirtualStylus::state() const noexcept {
  return {.motor_warmth = std::min(motors_.warmth(), 1.0)};
}

std::string VirtualStylus::trouble() const {
  if (!warm_.load(std::memory_order_relaxed)) return {};
  return "virtual stylus: its motors are warm; less force until they have cooled down";
}

std::unique_ptr<HapticDevice> make_virtual_stylus(const DeviceConfig& config) {
  return std::make_unique<VirtualStylus>(StylusScript::load(config.script), config.hand,
                                         config.sensor, config.motors);
}

}  // namespace irdm
