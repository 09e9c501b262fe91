#include "device_bridge/virtual_stylus.hpp"

#include <utility>

#include "device_bridge/bridge_config.hpp"

namespace irdm {

VirtualStylus::VirtualStylus(StylusScript script, const std::optional<HandParameters>& hand)
    : script_(std::move(script)) {
  if (hand) hand_.emplace(*hand, script_.at(0.0).tip);
}

StylusPose VirtualStylus::read(double time) noexcept {
  StylusPose pose = script_.at(time);
  if (hand_) {
    hand_->advance(time - time_, pose.tip, force_);
    pose.tip = hand_->position();
  }
  time_ = time;
  return pose;
}

std::unique_ptr<HapticDevice> make_virtual_stylus(const DeviceConfig& config) {
  return std::make_unique<VirtualStylus>(StylusScript::load(config.script), config.hand);
}

}  // namespace irdm
