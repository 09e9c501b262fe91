#include "device_bridge/haply/haply_device.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "common/realtime/clock.hpp"
#include "device_bridge/bridge_config.hpp"

namespace irdm {
namespace {

// Peak: HaplyHaptics/chai3d, CHaplyDevices. For long: the limit of a public user's driver
// (MAVYWAVY902/xpbd-tissue-sim, HaplyInverse3Device); Haply's own pages give none. Resolution:
// nominal.
DeviceRating rating_of(const std::string& type) noexcept {
  DeviceRating rating;
  if (type.empty() || type.starts_with("inverse3")) {
    rating.peak = 10.0;
    rating.continuous = 3.3;
    rating.resolution = 1e-5;
  }
  return rating;
}

}  // namespace

HaplyDevice::HaplyDevice(haply::InverseSettings settings) : settings_(std::move(settings)) {}

void HaplyDevice::open() {
  auto link = std::make_unique<haply::InverseLink>(settings_, mailbox_);
  link->open();
  link_ = std::move(link);
  rating_ = rating_of(link_->device().type);
}

void HaplyDevice::close() noexcept {
  if (link_ == nullptr) return;
  link_->close();
  report_ = link_->report();
  spdlog::info("Haply device {}: {}", link_->device().id, to_text(report_));
  link_.reset();
}

// What begins anew is not ready in one tick, so that its force comes back slowly.
StylusPose HaplyDevice::read(double) noexcept {
  mailbox_.reading.receive();
  const haply::InverseReading& newest = mailbox_.reading.front();
  const bool old = monotonic_ns() - newest.time_ns > haply::kLongestAgeNs;
  const bool anew = std::exchange(generation_, newest.generation) != newest.generation;
  repeated_ = std::exchange(time_ns_, newest.time_ns) == newest.time_ns;
  ready_ = newest.ready && !old && !anew;
  StylusPose pose{.tip = newest.tip, .orientation = newest.orientation, .buttons = newest.buttons};
  if (old) pose.tip.setConstant(std::numeric_limits<double>::quiet_NaN());
  return pose;
}

void HaplyDevice::write(const Wrench& shown) noexcept {
  haply::InverseForce& newest = mailbox_.force.back();
  newest.time_ns = monotonic_ns();
  newest.generation = generation_;
  newest.force = ready_ && shown.force.allFinite() ? shown.force : Vector3(Vector3::Zero());
  mailbox_.force.publish();
}

DeviceState HaplyDevice::state() const noexcept {
  return {.ready = ready_, .repeated = repeated_, .off = !ready_};
}

std::string HaplyDevice::trouble() const {
  return link_ != nullptr ? link_->trouble() : "";
}

std::string HaplyDevice::identity() const {
  return link_ != nullptr ? link_->device().type + ", " + link_->device().id : "";
}

haply::InverseSettings inverse_settings(const DeviceConfig& config) {
  haply::InverseSettings settings;
  if (config.service) settings.service = *config.service;
  settings.device = config.name;
  settings.grip = config.grip;
  settings.shared = config.shared;
  settings.scheduling = config.realtime;
  return settings;
}

std::unique_ptr<HapticDevice> make_haply_device(const DeviceConfig& config) {
  return std::make_unique<HaplyDevice>(inverse_settings(config));
}

}  // namespace irdm
