#include "device_bridge/safety/passivity.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {

void Passivity::observe(const Vector3& displacement, const Vector3& force) noexcept {
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

}  // namespace irdm
