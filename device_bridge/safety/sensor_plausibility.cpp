#include "device_bridge/safety/sensor_plausibility.hpp"

#include <algorithm>
#include <cmath>

#include "common/motion/rigid_body.hpp"
#include "common/realtime/clock.hpp"
#include "device_bridge/safety/time_since.hpp"

namespace irdm {
namespace {

// Of a quaternion's norm from 1.
constexpr double kOffNorm = 0.01;

// The way of the tip or that of the hand by the turn, whichever is longer [m, m/s].
double length(const Twist& twist) noexcept {
  return std::max(twist.linear.norm(), kLever * twist.angular.norm());
}

}  // namespace

ReadingVerdict SensorPlausibility::look(std::int64_t now_ns, const Vector3& tip,
                                        const Quaternion& orientation) noexcept {
  const ReadingVerdict clock = look_at_clock(now_ns);
  const ReadingVerdict reading = look_at_pose(now_ns, tip, orientation);
  return std::max(clock, reading);
}

ReadingVerdict SensorPlausibility::repeat(std::int64_t now_ns) noexcept {
  displacement_ = Twist{};
  const ReadingVerdict clock = look_at_clock(now_ns);
  const auto longest = static_cast<std::uint64_t>(limits_.gap_ns);
  const bool recent = last_good_ns_ && time_since(*last_good_ns_, now_ns) <= longest;
  return recent ? clock : std::max(clock, leave_out());
}

// A reading of no use.
ReadingVerdict SensorPlausibility::leave_out() noexcept {
  ++unused_;
  bad_ = std::min(bad_ + 1, limits_.bad_ticks);
  return bad_ >= limits_.bad_ticks ? ReadingVerdict::kFault : ReadingVerdict::kUnused;
}

ReadingVerdict SensorPlausibility::look_at_clock(std::int64_t now_ns) noexcept {
  const std::int64_t last_ns = last_ns_.value_or(now_ns);
  last_ns_ = now_ns;
  elapsed_ = 0.0;
  if (now_ns < last_ns) {
    return guards_.on(Guard::kClock) ? ReadingVerdict::kFault : ReadingVerdict::kGood;
  }
  const std::uint64_t gap = time_since(last_ns, now_ns);
  const bool long_gap = gap > static_cast<std::uint64_t>(limits_.gap_ns);
  elapsed_ =
      kNanosecond * static_cast<double>(std::min(gap, static_cast<std::uint64_t>(limits_.gap_ns)));
  return long_gap && guards_.on(Guard::kClock) ? ReadingVerdict::kTrip : ReadingVerdict::kGood;
}

bool SensorPlausibility::sane(const Vector3& tip, const Quaternion& orientation) const noexcept {
  if (!tip.allFinite() || tip.cwiseAbs().maxCoeff() > limits_.farthest) return false;
  return !limits_.turns || std::abs(orientation.norm() - 1.0) <= kOffNorm;
}

ReadingVerdict SensorPlausibility::look_at_pose(std::int64_t now_ns, const Vector3& tip,
                                                const Quaternion& orientation) noexcept {
  displacement_ = Twist{};
  velocity_ = Twist{};
  if (!sane(tip, orientation) && guards_.on(Guard::kReadingFinite)) {
    return leave_out();
  }
  bad_ = 0;
  const Quaternion turned = limits_.turns ? orientation.normalized() : Quaternion::Identity();
  Twist raw;
  if (last_good_ns_) {
    displacement_ = {tip - tip_, rotation_vector(turned * orientation_.conjugate())};
    const double seconds =
        kNanosecond * (static_cast<double>(now_ns) - static_cast<double>(*last_good_ns_));
    const double time = std::max(seconds, VelocityEstimate::kShortest);
    raw = {displacement_.linear / time, displacement_.angular / time};
  }
  velocity_ = {estimate_.next(now_ns, tip), raw.angular};
  tip_ = tip;
  orientation_ = turned;
  last_good_ns_ = now_ns;
  return look_at_speed(raw);
}

ReadingVerdict SensorPlausibility::look_at_speed(const Twist& raw) noexcept {
  const double speed = length(raw);
  const bool jumped = length(displacement_) > limits_.jump && speed > limits_.jump_speed;
  fast_ = speed > limits_.top_speed ? std::min(fast_ + 1, limits_.speed_ticks) : 0;
  if (jumped && guards_.on(Guard::kReadingJump)) return ReadingVerdict::kTrip;
  if (fast_ >= limits_.speed_ticks && guards_.on(Guard::kSpeed)) return ReadingVerdict::kTrip;
  return ReadingVerdict::kGood;
}

}  // namespace irdm
