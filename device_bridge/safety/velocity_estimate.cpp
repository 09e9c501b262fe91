#include "device_bridge/safety/velocity_estimate.hpp"

#include <algorithm>

#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

double time_between(std::int64_t earlier_ns, std::int64_t later_ns) noexcept {
  return kNanosecond * (static_cast<double>(later_ns) - static_cast<double>(earlier_ns));
}

// As `tip`, unless it is within the resolution of where it was.
Vector3 with_play(const Vector3& before, const Vector3& tip, double resolution) noexcept {
  const Vector3 way = tip - before;
  const double length = way.norm();
  if (resolution == 0.0) return tip;
  return length > resolution ? Vector3(tip - resolution / length * way) : before;
}

}  // namespace

Vector3 VelocityEstimate::next(std::int64_t time_ns, const Vector3& tip) noexcept {
  const Vector3 place = count_ == 0 ? tip : with_play(back(0).tip, tip, resolution_);
  readings_[count_ % readings_.size()] = {time_ns, place};
  ++count_;
  if (count_ == 1) return Vector3::Zero();
  Vector3 velocity = slope(1);
  if (resolution_ == 0.0) return velocity;
  for (std::size_t ticks = 2; ticks <= std::min(kLongest, count_ - 1); ++ticks) {
    const Vector3 longer = slope(ticks);
    if (!fits(longer, ticks)) break;
    velocity = longer;
  }
  return velocity;
}

const VelocityEstimate::Reading& VelocityEstimate::back(std::size_t ticks) const noexcept {
  return readings_[(count_ - 1 - ticks) % readings_.size()];
}

Vector3 VelocityEstimate::slope(std::size_t ticks) const noexcept {
  const double time = std::max(time_between(back(ticks).time_ns, back(0).time_ns), kShortest);
  return (back(0).tip - back(ticks).tip) / time;
}

// The line through the last reading and the one so many ticks before.
bool VelocityEstimate::fits(const Vector3& velocity, std::size_t ticks) const noexcept {
  for (std::size_t i = 1; i < ticks; ++i) {
    const double time = time_between(back(i).time_ns, back(0).time_ns);
    const Vector3 off = back(0).tip - time * velocity - back(i).tip;
    if (off.squaredNorm() > resolution_ * resolution_) return false;
  }
  return true;
}

}  // namespace irdm
