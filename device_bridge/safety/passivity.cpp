#include "device_bridge/safety/passivity.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {

void Passivity::observe(const Vector3& displacement, const Vector3& force) noexcept {
  before_ = last_;
  last_ = displacement;
  const double work = force.dot(displacement);
  if (!std::isfinite(work)) return;
  energy_ = std::clamp(energy_ - work, limits_.least, limits_.most);
}

double Passivity::damping(const Vector3& force, const Vector3& velocity,
                          double tick) const noexcept {
  const double lacking = force.dot(velocity) * tick - energy_;
  const double per_damping = velocity.squaredNorm() * tick;
  if (!(lacking > 0.0)) return 0.0;
  if (!(lacking < limits_.damping * per_damping)) return limits_.damping;
  return lacking / per_damping;
}

void Passivity::grant(double energy) noexcept {
  energy_ = std::min(limits_.most, energy_ + energy);
}

Vector3 Passivity::withheld(const Vector3& force) const noexcept {
  const Vector3 way = 2.0 * last_ - before_;
  const double left = std::max(0.0, energy_ + limits_.credit);
  const double excess = force.dot(way) - 0.5 * left;
  const double length = way.stableNorm();
  return excess > 0.0 ? Vector3(force - excess / length * (way / length)) : force;
}

}  // namespace irdm
