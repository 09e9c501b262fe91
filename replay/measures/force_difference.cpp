#include "replay/measures/force_difference.hpp"

#include <algorithm>
#include <cmath>

#include "replay/measures/perception.hpp"

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

Points smoothed(const Points& signal, double dt, double time) {
  if (!(dt > 0.0)) return signal;
  const auto reach = static_cast<Eigen::Index>(std::floor(0.5 * time / dt * (1 + 1e-9)));
  Points means(signal.rows(), 3);
  for (Eigen::Index k = 0; k < signal.rows(); ++k) {
    const Eigen::Index first = std::max<Eigen::Index>(k - reach, 0);
    const Eigen::Index last = std::min(k + reach, signal.rows() - 1);
    means.row(k) = signal.middleRows(first, last - first + 1).colwise().mean();
  }
  return means;
}

ForceDifference force_difference(const Points& a, const Points& b, double dt) {
  using namespace perception;
  const Points slow_a = smoothed(a, dt, kForceTime);
  const Points slow_b = smoothed(b, dt, kForceTime);
  ForceDifference found;
  std::size_t in_contact = 0;
  std::size_t above = 0;
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    const bool acts = !a.row(k).isZero(0.0) || !b.row(k).isZero(0.0);
    const double apart = (slow_a.row(k) - slow_b.row(k)).norm();
    const double share = acts ? apart / std::max(slow_a.row(k).norm(), kSmallForce) : 0.0;
    found.share.push_back(share);
    if (acts) ++in_contact;
    if (share > kForceShare) ++above;
    if (share > found.largest) {
      found.largest = share;
      found.worst_frame = static_cast<std::size_t>(k);
    }
  }
  found.contact = in_contact > 0;
  if (found.contact) {
    found.noticeable_time = static_cast<double>(above) / static_cast<double>(in_contact);
  }
  return found;
}

}  // namespace irdm::replay
