#include "replay/measures/compliance.hpp"

namespace irdm::replay {

void Compliance::add(double along, double force) noexcept {
  constexpr double kLeast = 0.05;
  if (!(force >= kLeast)) return;
  product_ += along * force;
  force_ += force * force;
}

double largest_along(const Points& u, const Vector3& direction) {
  return (u * direction.normalized()).maxCoeff();
}

}  // namespace irdm::replay
