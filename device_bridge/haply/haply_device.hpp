#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "device_bridge/haply/inverse_link.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm {

struct DeviceConfig;

/// A Haply Inverse3 by its Inverse Service, with orientation and buttons of a VerseGrip. Force
/// only. D has its origin where the device has it, +x right, +y up, +z towards the person, as for
/// OpenHaptics. The ticks are the servo thread's; the service is spoken to in another.
///
/// A state that is older than 50 ms is a bad reading, and the device not ready: so it is without
/// service, unplugged and not calibrated. It comes back by itself, its force as after arming.
class HaplyDevice : public HapticDevice {
 public:
  explicit HaplyDevice(haply::InverseSettings settings);
  ~HaplyDevice() override { close(); }

  void open() override;
  void close() noexcept override;
  StylusPose read(double time) noexcept override;
  void write(const Wrench& shown) noexcept override;
  DeviceState state() const noexcept override;
  bool simulated() const noexcept override { return false; }
  double duration() const noexcept override { return std::numeric_limits<double>::infinity(); }
  DeviceRating rating() const noexcept override { return rating_; }
  std::string identity() const override;
  std::string trouble() const override;

  /// Of the connection that was closed last.
  const haply::InverseReport& report() const noexcept { return report_; }

 private:
  const haply::InverseSettings settings_;
  haply::InverseMailbox mailbox_;
  std::unique_ptr<haply::InverseLink> link_;  ///< while open
  haply::InverseReport report_;
  DeviceRating rating_;
  std::uint64_t generation_ = 0;  ///< of the reading before
  std::int64_t time_ns_ = 0;      ///< the same
  bool ready_ = false;
  bool repeated_ = false;
};

/// What a configuration says of one.
haply::InverseSettings inverse_settings(const DeviceConfig& config);

/// For the registry.
std::unique_ptr<HapticDevice> make_haply_device(const DeviceConfig& config);

}  // namespace irdm
