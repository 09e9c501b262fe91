#include "device_bridge/forcedimension/forcedimension_device.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "common/error.hpp"
#include "device_bridge/bridge_config.hpp"

namespace irdm {
namespace {

constexpr unsigned char kOn = 1;
constexpr unsigned char kOff = 0;
constexpr int kMostFailures = 50;  // in a row, then it is lost

// From the driver's axes (towards the person, right, up) to D's (right, up, towards the person).
const Matrix3& axes() noexcept {
  static const Matrix3 kAxes = (Matrix3() << 0, 1, 0, 0, 0, 1, 1, 0, 0).finished();
  return kAxes;
}

// Of a force or torque; what is not finite is none.
Vector3 to_driver(const Vector3& vector) noexcept {
  if (!vector.allFinite()) return Vector3::Zero();
  return axes().transpose() * vector;
}

}  // namespace

ForceDimensionDevice::ForceDimensionDevice(std::string name, const dhd::Api& api)
    : name_(std::move(name)), dhd_(api) {}

std::string ForceDimensionDevice::label() const {
  return name_.empty() ? "first Force Dimension device" : "Force Dimension device " + name_;
}

int ForceDimensionDevice::open_by_name() const {
  if (name_.empty()) return dhd_.open();
  if (name_.size() != 1 || name_[0] < '0' || name_[0] > '9') {
    throw Error(label(), "has no number", "give its number as name, \"0\" for the first");
  }
  return dhd_.open_id(static_cast<char>(name_[0] - '0'));
}

void ForceDimensionDevice::open() {
  const int id = open_by_name();
  const auto fail = [&](const char* what) {
    const char* const words = dhd_.error_get_last_str();
    throw Error(label(), std::string(what) + (words != nullptr ? words : "no reason given"),
                "check power and cable, the udev rule for USB vendors 1451 and 0403, and that no "
                "other program uses it");
  };
  if (id < 0) fail("cannot be opened: ");
  id_ = id;
  if (dhd_.enable_force(kOn, static_cast<char>(id_)) < 0) fail("its force cannot be turned on: ");
  const bool wrist = dhd_.has_active_wrist(static_cast<char>(id_));
  if (wrist) rating_.peak_torque = std::numeric_limits<double>::infinity();
  const char* const model = dhd_.get_system_name(static_cast<char>(id_));
  spdlog::info("{}: {}, {}", label(), model != nullptr ? model : "unknown",
               wrist ? "force and torque" : "force");
}

void ForceDimensionDevice::close() noexcept {
  if (id_ == kClosed) return;
  write({});
  const auto id = static_cast<char>(std::exchange(id_, kClosed));
  dhd_.enable_force(kOff, id);
  dhd_.close(id);
}

StylusPose ForceDimensionDevice::read(double) noexcept {
  const auto id = static_cast<char>(id_);
  Vector3 tip = Vector3::Zero();
  double rows[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const bool good = dhd_.get_position(&tip.x(), &tip.y(), &tip.z(), id) >= 0 &&
                    dhd_.get_orientation_frame(rows, id) >= 0;
  count(!good);
  StylusPose pose;
  if (!good) {
    pose.tip.setConstant(std::numeric_limits<double>::quiet_NaN());
    return pose;
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> frame(&rows[0][0]);
  pose.tip = axes() * tip;
  pose.orientation = Quaternion(Matrix3(axes() * frame * axes().transpose())).normalized();
  pose.buttons = dhd_.get_button_mask(id);
  return pose;
}

// Three readings in a row that failed are a fault of the safety filter already.
void ForceDimensionDevice::count(bool failed) noexcept {
  failures_ = failed ? failures_ + 1 : 0;
  if (failures_ >= kMostFailures) lost_.store(true, std::memory_order_relaxed);
}

void ForceDimensionDevice::write(const Wrench& shown) noexcept {
  const auto id = static_cast<char>(id_);
  const Vector3 f = to_driver(shown.force);
  const Vector3 t = to_driver(shown.torque);
  if (rating_.peak_torque > 0.0) {
    dhd_.set_force_and_torque(f.x(), f.y(), f.z(), t.x(), t.y(), t.z(), id);
  } else {
    dhd_.set_force(f.x(), f.y(), f.z(), id);
  }
}

DeviceState ForceDimensionDevice::state() const noexcept {
  const bool lost = lost_.load(std::memory_order_relaxed);
  return {.failed = lost, .lost = lost};
}

std::string ForceDimensionDevice::trouble() const {
  if (!lost_.load(std::memory_order_relaxed)) return {};
  return label() + ": no readings any more; check power and cable, and start irdm-bridge again";
}

std::unique_ptr<HapticDevice> make_forcedimension_device(const DeviceConfig& config) {
  return std::make_unique<ForceDimensionDevice>(config.name, dhd::library());
}

}  // namespace irdm
