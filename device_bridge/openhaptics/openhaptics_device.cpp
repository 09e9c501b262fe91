#include "device_bridge/openhaptics/openhaptics_device.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <cmath>
#include <utility>

#include "common/error.hpp"
#include "device_bridge/bridge_config.hpp"
#include "device_bridge/openhaptics/hd_error.hpp"
#include "device_bridge/openhaptics/hd_library.hpp"

namespace irdm {
namespace {

constexpr double kMetre = 1e-3;                  // per mm
constexpr double kNewtonMetre = 1e-3;            // per mN m
constexpr std::int64_t kWarmNs = 5'000'000'000;  // that a warning of warm motors counts
constexpr std::int32_t kButtonBits = 15;         // four buttons
constexpr std::int32_t kForceAndTorque = 6;      // actuated axes
constexpr double kResolution = 5.5e-5;           // nominal, of a Touch; others are finer [m]

using Transform = std::array<double, 16>;

// Not a number unless the transform holds a rotation.
StylusPose to_pose(const Transform& transform, std::int32_t buttons) noexcept {
  const Eigen::Map<const Eigen::Matrix4d> matrix(transform.data());  // column by column as well
  const Matrix3 rotation = matrix.topLeftCorner<3, 3>();
  StylusPose pose;
  pose.buttons = static_cast<std::uint32_t>(buttons & kButtonBits);
  pose.tip = kMetre * matrix.topRightCorner<3, 1>();
  pose.orientation = Quaternion(rotation).normalized();
  constexpr double kTolerance = 0.1;
  if (!(std::abs(rotation.determinant() - 1.0) < kTolerance)) {
    pose.tip.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return pose;
}

double rated(double told) noexcept {
  return std::isfinite(told) && told > 0.0 ? told : std::numeric_limits<double>::infinity();
}

std::uint64_t packed(const hd::ErrorInfo& error) noexcept {
  return std::uint64_t{error.code} << 32 | static_cast<std::uint32_t>(error.internal);
}

hd::ErrorInfo unpacked(std::uint64_t both) noexcept {
  return {.code = static_cast<hd::Code>(both >> 32),
          .internal = static_cast<std::int32_t>(both & 0xFFFFFFFF)};
}

}  // namespace

OpenHapticsDevice::OpenHapticsDevice(std::string name,
                                     std::shared_ptr<OpenHapticsScheduler> scheduler)
    : name_(std::move(name)),
      scheduler_(std::move(scheduler)),
      hd_(scheduler_->api()),
      calibration_(hd_) {}

std::string OpenHapticsDevice::label() const {
  return name_.empty() ? "default device" : "device '" + name_ + "'";
}

void OpenHapticsDevice::open() {
  initialise();
  turn_on();
  read_rating();
  calibration_.choose_style();
  scheduler_->add(*this);
  const auto text = [&](hd::Name name) {
    const char* const word = hd_.get_string(name);
    return std::string(word != nullptr ? word : "unknown");
  };
  const bool torque = rating_.peak_torque > 0.0;
  identity_ = text(hd::kModel) + ", serial number " + text(hd::kSerialNumber);
  spdlog::info("{}: {}, at most {} N, {} N for long{}", label(), identity_, rating_.peak,
               rating_.continuous,
               torque ? ", and " + std::to_string(rating_.peak_torque) + " N m" : "");
  scheduler_->forget_errors();
  look_at_calibration();
}

// The vendor's setup files have decimal points, whatever the locale that a library may have set.
void OpenHapticsDevice::initialise() {
  std::setlocale(LC_NUMERIC, "C");
  const hd::Handle handle = hd_.init_device(name_.empty() ? nullptr : name_.c_str());
  std::setlocale(LC_NUMERIC, "C");
  const hd::ErrorInfo error = hd_.get_error();
  if (handle == hd::kInvalidHandle || hd::describe(error.code).meaning > hd::Meaning::kWarm) {
    if (handle != hd::kInvalidHandle) hd_.disable_device(handle);
    const hd::Advice advice = hd::start_advice(name_, error, hd::look_at_touch_system());
    throw Error(label(), advice.what, advice.remedy);
  }
  handle_ = handle;
}

void OpenHapticsDevice::turn_on() {
  hd_.make_current_device(handle_);
  for (const hd::Name limit :
       {hd::kMaxForceClamping, hd::kForceLimit, hd::kVelocityLimit, hd::kForceImpulseLimit}) {
    hd_.enable(limit);  // not every driver lets them be chosen; they are on by themselves
  }
  hd_.enable(hd::kForceOutput);
  if (hd_.is_enabled(hd::kForceOutput) != 0) return;
  const hd::ErrorInfo error = hd_.get_error();
  throw Error(label(), "its force cannot be turned on: " + to_text(error),
              hd::describe(error.code).remedy);
}

void OpenHapticsDevice::read_rating() {
  double peak = 0.0;
  double continuous = 0.0;
  hd_.get_doublev(hd::kMaxForce, &peak);
  hd_.get_doublev(hd::kMaxContinuousForce, &continuous);
  rating_ = {.peak = rated(peak), .continuous = rated(continuous), .resolution = kResolution};
  std::int32_t axes = 0;
  hd_.get_integerv(hd::kOutputDof, &axes);
  if (axes < kForceAndTorque) return;
  double torque = 0.0;
  double continuous_torque = 0.0;
  hd_.get_doublev(hd::kMaxTorque, &torque);
  hd_.get_doublev(hd::kMaxContinuousTorque, &continuous_torque);
  rating_.peak_torque = kNewtonMetre * rated(torque);
  rating_.continuous_torque = kNewtonMetre * rated(continuous_torque);
}

void OpenHapticsDevice::close() noexcept {
  if (handle_ == hd::kInvalidHandle) return;
  scheduler_->remove(*this);
  hd_.make_current_device(handle_);
  hd_.disable(hd::kForceOutput);
  hd_.disable_device(handle_);
  handle_ = hd::kInvalidHandle;
}

void OpenHapticsDevice::begin_frame() noexcept {
  hd_.begin_frame(handle_);
  in_frame_ = true;
}

StylusPose OpenHapticsDevice::read(double) noexcept {
  if (in_frame_) write({});
  count_tick();
  begin_frame();
  Transform transform;
  transform.fill(std::numeric_limits<double>::quiet_NaN());
  std::int32_t buttons = 0;
  hd_.get_doublev(hd::kTransform, transform.data());
  hd_.get_integerv(hd::kButtons, &buttons);
  output_on_.store(hd_.is_enabled(hd::kForceOutput) != 0, std::memory_order_relaxed);
  scheduler_->fetch_errors(*this);
  read_warmth();
  StylusPose pose = to_pose(transform, buttons);
  if (std::exchange(bad_frame_, false)) {
    pose.tip.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return pose;
}

// Not every device knows its temperature, and one that does not is no bad reading.
void OpenHapticsDevice::read_warmth() noexcept {
  std::array<double, hd::kMotors> motors{};
  if (tells_warmth_) {
    hd_.get_doublev(hd::kMotorTemperature, motors.data());
    const hd::ErrorInfo error = hd_.get_error();
    tells_warmth_ = hd::describe(error.code).meaning != hd::Meaning::kBadFrame;
    if (tells_warmth_) scheduler_->give(error, *this);
  }
  double warmest = 0.0;
  for (const double motor : motors) {
    if (motor > warmest) warmest = std::min(motor, 1.0);
  }
  warm_ns_ = std::max<std::int64_t>(warm_ns_ - scheduler_->period_ns(), 0);
  state_.motor_temperature = warm_ns_ > 0 ? 1.0 : warmest;
}

void OpenHapticsDevice::count_tick() noexcept {
  const std::int64_t elapsed_ns = scheduler_->period_ns();
  warnings_.tick(elapsed_ns);
  if (!warnings_.paused()) warned_.store(0, std::memory_order_relaxed);
  if (calibration_.due(elapsed_ns)) look_at_calibration();
}

// Between frames, as the driver wants it.
void OpenHapticsDevice::look_at_calibration() noexcept {
  hd_.make_current_device(handle_);
  calibrating_ = true;
  calibration_.look();
  scheduler_->fetch_errors(*this);
  calibrating_ = false;
}

// While the driver only warns, the safety filter takes the force off at its own rate.
void OpenHapticsDevice::write(const Wrench& shown) noexcept {
  if (!in_frame_) begin_frame();
  const bool sound = shown.force.allFinite() && shown.torque.allFinite() && calibration_.good();
  const Wrench sent = sound ? shown : Wrench{};
  hd_.set_doublev(hd::kForce, sent.force.data());
  if (rating_.peak_torque > 0.0) {
    const Vector3 torque = sent.torque / kNewtonMetre;
    hd_.set_doublev(hd::kTorque, torque.data());
  }
  shows_force_ = !sent.is_zero();
  hd_.end_frame(handle_);
  in_frame_ = false;
  scheduler_->fetch_errors(*this);
}

DeviceState OpenHapticsDevice::state() const noexcept {
  DeviceState state = state_;
  const bool shows = calibration_.good() && output_on_.load(std::memory_order_relaxed);
  state.off = state.lost || !shows;
  state.ready = shows && !warnings_.paused();
  return state;
}

void OpenHapticsDevice::take(const hd::ErrorInfo& error) noexcept {
  if (calibrating_ && error.code == hd::kDeviceFault) return calibration_.fail();
  switch (hd::describe(error.code).meaning) {
    case hd::Meaning::kNothing:
      return;
    case hd::Meaning::kWarm:
      warm_ns_ = kWarmNs;
      return;
    case hd::Meaning::kBadFrame:
      bad_frame_ = true;
      return;
    case hd::Meaning::kWarning:
      return warn(error);
    case hd::Meaning::kUnsafe:
      return fail(error);
    case hd::Meaning::kLost:
      state_.lost = true;
      return fail(error);
  }
}

void OpenHapticsDevice::warn(const hd::ErrorInfo& error) noexcept {
  if (!warnings_.bearable(shows_force_)) return fail(error);
  warned_.store(packed(error), std::memory_order_relaxed);
}

void OpenHapticsDevice::fail(const hd::ErrorInfo& error) noexcept {
  state_.failed = true;
  std::uint64_t none = 0;
  fault_.compare_exchange_strong(none, packed(error), std::memory_order_relaxed);
}

std::string OpenHapticsDevice::trouble() const {
  if (const std::uint64_t fault = fault_.load(std::memory_order_relaxed); fault != 0) {
    const hd::ErrorInfo error = unpacked(fault);
    return label() + ": no force any more: " + to_text(error) + "; " +
           hd::describe(error.code).remedy;
  }
  if (const std::uint64_t warning = warned_.load(std::memory_order_relaxed); warning != 0) {
    return label() + ": no force for a moment: " + to_text(unpacked(warning)) +
           "; move more slowly and press less: it stays off when this happens often";
  }
  if (!output_on_.load(std::memory_order_relaxed)) {
    return label() + ": no force: its driver has turned it off; start irdm-bridge again";
  }
  const std::string calibration = calibration_.trouble();
  return calibration.empty() ? "" : label() + ": " + calibration;
}

std::unique_ptr<HapticDevice> make_openhaptics_device(const DeviceConfig& config) {
  // As long as one of its devices is there: the driver has one scheduler.
  static std::weak_ptr<OpenHapticsScheduler> scheduler;
  std::shared_ptr<OpenHapticsScheduler> shared = scheduler.lock();
  if (!shared) {
    shared = std::make_shared<OpenHapticsScheduler>(hd::library());
    scheduler = shared;
  }
  return std::make_unique<OpenHapticsDevice>(config.name, std::move(shared));
}

}  // namespace irdm
