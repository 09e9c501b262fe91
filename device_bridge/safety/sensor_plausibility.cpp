#include "device_bridge/safety/sensor_plausibility.hpp"

#include <algorithm>

#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

// Two ticks can follow one another closely after a late one; no speed is told from less [s].
constexpr double kShortest = 5e-4;

}  // namespace

ReadingVerdict SensorPlausibility::look(std::int64_t now_ns, const Vector3& tip) noexcept {
  const ReadingVerdict clock = look_at_clock(now_ns);
  const ReadingVerdict reading = look_at_tip(now_ns, tip);
  return std::max(clock, reading);
}

ReadingVerdict SensorPlausibility::look_at_clock(std::int64_t now_ns) noexcept {
  const std::int64_t last_ns = last_ns_.value_or(now_ns);
  last_ns_ = now_ns;
  elapsed_ = 0.0;
  if (now_ns < last_ns) {
    return guards_.on(Guard::kClock) ? ReadingVerdict::kFault : ReadingVerdict::kGood;
  }
  // Unsigned: exact for any two times.
  const std::uint64_t gap =
      static_cast<std::uint64_t>(now_ns) - static_cast<std::uint64_t>(last_ns);
  const bool long_gap = gap > static_cast<std::uint64_t>(limits_.gap_ns);
  elapsed_ =
      kNanosecond * static_cast<double>(std::min(gap, static_cast<std::uint64_t>(limits_.gap_ns)));
  return long_gap && guards_.on(Guard::kClock) ? ReadingVerdict::kTrip : ReadingVerdict::kGood;
}

ReadingVerdict SensorPlausibility::look_at_tip(std::int64_t now_ns, const Vector3& tip) noexcept {
  displacement_.setZero();
  velocity_.setZero();
  const bool sane = tip.allFinite() && tip.cwiseAbs().maxCoeff() <= limits_.farthest;
  if (!sane && guards_.on(Guard::kReadingFinite)) {
    ++unused_;
    bad_ = std::min(bad_ + 1, limits_.bad_ticks);
    return bad_ >= limits_.bad_ticks ? ReadingVerdict::kFault : ReadingVerdict::kUnused;
  }
  bad_ = 0;
  if (last_good_ns_) {
    displacement_ = tip - tip_;
    const double seconds =
        kNanosecond * (static_cast<double>(now_ns) - static_cast<double>(*last_good_ns_));
    velocity_ = displacement_ / std::max(seconds, kShortest);
  }
  tip_ = tip;
  last_good_ns_ = now_ns;
  return look_at_speed();
}

ReadingVerdict SensorPlausibility::look_at_speed() noexcept {
  const double speed = velocity_.norm();
  const bool jumped = displacement_.norm() > limits_.jump && speed > limits_.jump_speed;
  fast_ = speed > limits_.top_speed ? std::min(fast_ + 1, limits_.speed_ticks) : 0;
  if (jumped && guards_.on(Guard::kReadingJump)) return ReadingVerdict::kTrip;
  if (fast_ >= limits_.speed_ticks && guards_.on(Guard::kSpeed)) return ReadingVerdict::kTrip;
  return ReadingVerdict::kGood;
}

}  // namespace irdm
