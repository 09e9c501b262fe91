#include "device_bridge/safety/guards.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {

Vector3 limit_rate(const Vector3& from, const Vector3& to, const RateLimits& limits,
                   double elapsed) noexcept {
  const Vector3 way = to - from;
  const double length = way.norm();
  if (!(length > 0.0)) return to;
  const double time = std::clamp(elapsed, 0.0, limits.longest);
  // How much of the way leads nearer to zero, and how fast it may be gone.
  const double falling = std::clamp(-from.dot(way) / length, 0.0, length);
  const double blend = std::clamp(2.0 - 2.0 * to.norm() / from.norm(), 0.0, 1.0);
  const double fall = limits.rise + blend * (limits.fall - limits.rise);
  double travelled = fall * time;
  if (travelled > falling) travelled = falling + limits.rise * (time - falling / fall);
  return travelled >= length ? to : Vector3(from + travelled / length * way);
}

void ThermalDerating::heat(double force, double elapsed, double reported) noexcept {
  const double load = force / limits_.continuous;
  if (std::isfinite(load)) {
    warmth_ += (load * load - warmth_) * -std::expm1(-elapsed / limits_.time_constant);
  }
  const double warmest = reported > warmth_ ? std::min(reported, 1.0) : warmth_;
  const double over = std::clamp((warmest - limits_.begin) / (1.0 - limits_.begin), 0.0, 1.0);
  const double lowest = std::min(limits_.continuous, limits_.peak);
  const double wanted = limits_.peak - over * (limits_.peak - lowest);
  const double change = limits_.slew * elapsed;
  limit_ = std::clamp(wanted, limit_ - change, limit_ + change);
}

}  // namespace irdm
