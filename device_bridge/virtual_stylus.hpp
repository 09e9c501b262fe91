#pragma once

#include <memory>
#include <optional>

#include "device_bridge/haptic_device.hpp"
#include "device_bridge/virtual_hand.hpp"

namespace irdm {

struct DeviceConfig;

/// A stylus without hardware: it moves as scripted, or is held by a simulated hand that follows the
/// script and feels the force. Orientation and buttons are always those of the script.
class VirtualStylus : public HapticDevice {
 public:
  explicit VirtualStylus(StylusScript script, const std::optional<HandParameters>& hand = {});

  void open() override {}
  void close() noexcept override {}
  StylusPose read(double time) noexcept override;
  void write(const Vector3& force) noexcept override { force_ = force; }
  bool simulated() const noexcept override { return true; }
  double duration() const noexcept override { return script_.end(); }

 private:
  StylusScript script_;
  std::optional<VirtualHand> hand_;
  double time_ = 0.0;
  Vector3 force_ = Vector3::Zero();
};

/// For the registry: loads the script that the configuration names. Throws Error.
std::unique_ptr<HapticDevice> make_virtual_stylus(const DeviceConfig& config);

}  // namespace irdm
