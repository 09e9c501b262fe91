#include "device_bridge/safety/rate_limit.hpp"

#include <algorithm>

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

}  // namespace irdm
