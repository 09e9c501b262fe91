#include "device_bridge/forcedimension/forcedimension_device.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <set>
#include <utility>

#include "common/error.hpp"
#include "device_bridge/bridge_config.hpp"

namespace irdm {
namespace {

constexpr unsigned char kOn = 1;
constexpr unsigned char kOff = 0;
constexpr int kMostFailures = 50;  // in a row, then it is lost
constexpr int kStatusTicks = 8;    // from one status to the next: force off is seen within 10 ms
constexpr int kPause = 60;         // statuses without force before it is turned on again: 0.5 s
constexpr int kNewOmega3 = 110;    // type, whose only button is bit 1

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

// By the driver's number of the model, from public drivers' tables (chai3d's CDeltaDevices).
// Resolutions are nominal.
DeviceRating rating_of(int type, bool active_wrist) noexcept {
  struct Rated {
    int first, last;           // types
    double force;              // [N]
    double torque;             // [N m], of an active wrist
    double resolution = 1e-5;  // [m]
  };
  constexpr std::array kRated{Rated{31, 31, 20.0, 0.0},        Rated{61, 64, 20.0, 0.2},    // Delta
                              Rated{32, 37, 12.0, 0.0},        Rated{110, 110, 12.0, 0.0},  // Omega
                              Rated{60, 60, 8.0, 0.0, 6.4e-5},  // Falcon
                              Rated{104, 105, 12.0, 0.2}};      // Sigma
  DeviceRating rating;
  if (active_wrist) rating.peak_torque = std::numeric_limits<double>::infinity();
  for (const Rated& rated : kRated) {
    if (type < rated.first || type > rated.last) continue;
    rating.peak = rated.force;
    rating.resolution = rated.resolution;
    if (active_wrist && rated.torque > 0.0) rating.peak_torque = rated.torque;
  }
  return rating;
}

const char* words(dhd::ForceOff cause) noexcept {
  switch (cause) {
    case dhd::ForceOff::kButton:
      return "the force button; press it again";
    case dhd::ForceOff::kVelocity:
      return "it was moved too fast; the force comes back by itself";
    case dhd::ForceOff::kWatchdog:
      return "its watchdog; the force comes back by itself";
    case dhd::ForceOff::kUnplugged:
      return "the cable; plug it in, and start irdm-bridge again";
    case dhd::ForceOff::kDeadman:
      return "nobody holds the handle; take it";
    default:
      return "no reason given; press its force button";
  }
}

// The driver gives the same id again for one that is open.
std::mutex open_mutex;
std::set<int> open_ids;

}  // namespace

ForceDimensionDevice::ForceDimensionDevice(std::string name, const dhd::Api& api, bool auto_init)
    : name_(std::move(name)), dhd_(api), auto_init_(auto_init) {}

std::string ForceDimensionDevice::label() const {
  return name_.empty() ? "first Force Dimension device" : "Force Dimension device " + name_;
}

void ForceDimensionDevice::fail(const std::string& what) const {
  const char* const reason = dhd_.error_get_last_str();
  throw Error(label(), what + (reason != nullptr ? reason : "no reason given"),
              "check power and cable, its udev rule (`irdm-bridge doctor` gives it), and that no "
              "other program uses it");
}

int ForceDimensionDevice::open_by_name() const {
  constexpr std::size_t kLongest = 9;
  if (name_.empty()) return dhd_.open();
  const bool digits =
      std::all_of(name_.begin(), name_.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!digits || name_.size() > kLongest) {
    throw Error(label(), "has no number",
                "give its number as name, \"0\" for the first, or its serial number");
  }
  const int number = std::stoi(name_);
  return name_.size() == 1 ? dhd_.open_id(static_cast<char>(number)) : dhd_.open_serial(number);
}

void ForceDimensionDevice::open() {
  const int id = open_by_name();
  if (id < 0) fail("cannot be opened: ");
  {
    const std::lock_guard<std::mutex> lock(open_mutex);
    if (!open_ids.insert(id).second) {
      throw Error(label(), "is open already", "give each [[device]] a name of its own");
    }
  }
  id_ = id;
  try {
    prepare();
  } catch (...) {
    close();
    throw;
  }
}

void ForceDimensionDevice::prepare() {
  const auto id = static_cast<char>(id_);
  std::array<int, dhd::kStatusRoom> status{};
  if (dhd_.get_status(status.data(), id) < 0) fail("does not tell its status: ");
  initialise(status[dhd::kInitialised] != 0);
  dhd_.set_gravity_compensation(1, id);
  if (dhd_.enable_force(kOn, id) < 0) fail("its force cannot be turned on: ");
  write({});
  const char* const name = dhd_.get_system_name(id);
  const std::string model = name != nullptr ? name : "unknown";
  type_ = dhd_.get_system_type(id);
  const bool wrist = dhd_.has_active_wrist(id);
  rating_ = rating_of(type_, wrist);
  if (dhd_.has_gripper(id) && dhd_.emulate_button != nullptr) dhd_.emulate_button(kOn, id);
  if (std::isfinite(rating_.peak) && dhd_.set_max_force != nullptr) {
    dhd_.set_max_force(rating_.peak, id);
  }
  unsigned short serial = 0;
  const bool numbered = dhd_.get_serial_number(&serial, id) >= 0;
  identity_ = model + (numbered ? ", serial number " + std::to_string(serial) : "");
  spdlog::info("{}: {}, {}", label(), identity_, wrist ? "force and torque" : "force");
}

void ForceDimensionDevice::initialise(bool initialised) {
  initialised_ = initialised;
  if (initialised || !auto_init_) return;
  if (dhd_.auto_init == nullptr) {
    throw Error(label(), "cannot be initialised: auto_init needs libdrd",
                "name libdrd.so in $FORCEDIMENSION_LIB, or use the vendor's program");
  }
  spdlog::warn("{}: moves by itself now, to be initialised: keep hands off", label());
  if (dhd_.auto_init(static_cast<char>(id_)) < 0) fail("cannot be initialised: ");
  initialised_ = true;
}

void ForceDimensionDevice::close() noexcept {
  if (id_ == kClosed) return;
  write({});
  const int id = std::exchange(id_, kClosed);
  dhd_.enable_force(kOff, static_cast<char>(id));
  dhd_.close(static_cast<char>(id));
  const std::lock_guard<std::mutex> lock(open_mutex);
  open_ids.erase(id);
  if (repeats_ + refused_ + saturated_ == 0) return;
  spdlog::info("{}: {} readings were repeated, {} forces failed, {} were more than its motors give",
               label(), repeats_, refused_, saturated_);
}

StylusPose ForceDimensionDevice::read(double) noexcept {
  const auto id = static_cast<char>(id_);
  if (++ticks_ >= kStatusTicks) look();
  Vector3 tip = Vector3::Zero();
  double rows[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int result =
      dhd_.get_position_and_orientation_frame(&tip.x(), &tip.y(), &tip.z(), rows, id);
  count(result < 0, failures_);  // three are a fault of the safety filter already
  repeated_ = result == dhd::kRepeated;
  if (repeated_) ++repeats_;
  if (result < 0) {
    pose_.tip.setConstant(std::numeric_limits<double>::quiet_NaN());
    return pose_;
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> frame(&rows[0][0]);
  pose_.tip = axes() * tip;
  pose_.orientation = Quaternion(Matrix3(axes() * frame * axes().transpose())).normalized();
  pose_.buttons = dhd_.get_button_mask(id);
  if (type_ == kNewOmega3) pose_.buttons >>= 1;
  return pose_;
}

// What the device does by itself.
void ForceDimensionDevice::look() noexcept {
  const auto id = static_cast<char>(id_);
  ticks_ = 0;
  std::array<int, dhd::kStatusRoom> status{};
  if (dhd_.get_status(status.data(), id) < 0) return;  // a reading fails as well
  const bool on = status[dhd::kForceOn] != 0;
  const auto cause = static_cast<dhd::ForceOff>(status[dhd::kForceOffCause]);
  initialised_.store(status[dhd::kInitialised] != 0, std::memory_order_relaxed);
  cause_.store(cause, std::memory_order_relaxed);
  if (force_on_.exchange(on, std::memory_order_relaxed) && !on) pause_ = kPause;
  if (cause == dhd::ForceOff::kUnplugged) lost_.store(true, std::memory_order_relaxed);
  const bool comes_back = cause == dhd::ForceOff::kVelocity || cause == dhd::ForceOff::kWatchdog ||
                          cause == dhd::ForceOff::kSoftware;
  if (on || !comes_back) return;
  if (--pause_ <= 0) dhd_.enable_force(kOn, id);
}

void ForceDimensionDevice::count(bool failed, int& in_a_row) noexcept {
  in_a_row = failed ? in_a_row + 1 : 0;
  if (in_a_row >= kMostFailures) lost_.store(true, std::memory_order_relaxed);
}

// Without an active wrist the driver leaves the torque out.
void ForceDimensionDevice::write(const Wrench& shown) noexcept {
  const Vector3 f = to_driver(shown.force);
  const Vector3 t = rating_.peak_torque > 0.0 ? to_driver(shown.torque) : Vector3::Zero();
  const int result = dhd_.set_force_and_torque_and_gripper_force(
      f.x(), f.y(), f.z(), t.x(), t.y(), t.z(), 0.0, static_cast<char>(id_));
  count(result < 0, refusals_);
  if (result < 0) ++refused_;
  if (result == dhd::kSaturated) ++saturated_;
  cut_off_ = result < 0 || result == dhd::kSaturated;
}

DeviceState ForceDimensionDevice::state() const noexcept {
  const bool lost = lost_.load(std::memory_order_relaxed);
  const bool shows =
      initialised_.load(std::memory_order_relaxed) && force_on_.load(std::memory_order_relaxed);
  return {.ready = shows,
          .failed = lost,
          .lost = lost,
          .repeated = repeated_,
          .saturated = cut_off_,
          .off = lost || !shows};
}

std::string ForceDimensionDevice::trouble() const {
  if (lost_.load(std::memory_order_relaxed)) {
    return label() +
           ": does not answer any more; check power and cable, and start irdm-bridge again";
  }
  if (!initialised_.load(std::memory_order_relaxed)) {
    return label() +
           ": is not initialised, no force; use the vendor's program, or auto_init = true";
  }
  const dhd::ForceOff cause = cause_.load(std::memory_order_relaxed);
  const bool off = !force_on_.load(std::memory_order_relaxed) && cause != dhd::ForceOff::kNone;
  return off ? label() + ": its force is off: " + words(cause) : "";
}

std::unique_ptr<HapticDevice> make_forcedimension_device(const DeviceConfig& config) {
  return std::make_unique<ForceDimensionDevice>(config.name, dhd::library(), config.auto_init);
}

}  // namespace irdm
