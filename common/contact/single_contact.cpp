#include "common/contact/single_contact.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {
namespace {

// Enough for directions to settle to rounding on any W that is not close to singular.
constexpr int kMaxTurns = 60;

Vector3 sideways(const Vector3& v, const Vector3& normal) noexcept {
  return v - v.dot(normal) * normal;
}

// Force on the cone for a direction d along the surface: f = N (mu d - n), with N from the normal
// part of W f = gap. Where friction would hold the point without end (W_nn <= mu W_nd), N is that
// without friction.
Vector3 force_towards(const Matrix3& W, const Vector3& gap, const Vector3& normal, double mu,
                      const Vector3& d) noexcept {
  const Vector3 on_cone = mu * d - normal;
  const double yielding = -normal.dot(W * on_cone);
  const double frictionless = normal.dot(W * normal);
  const double push = -normal.dot(gap) / std::max(yielding, 0.05 * frictionless);
  return push * on_cone;
}

// Finds d parallel to the slip that it leaves: turns d towards the slip until it stays.
SingleContact slip(const Matrix3& W, const Vector3& gap, const Vector3& normal, double mu,
                   const Vector3& stick) noexcept {
  SingleContact result;
  result.mode = ContactMode::kSlipping;
  Vector3 d = sideways(stick, normal).normalized();
  const double scale = W.trace();
  for (int turn = 0; turn < kMaxTurns; ++turn) {
    result.force = force_towards(W, gap, normal, mu, d);
    result.slip = sideways(gap - W * result.force, normal);
    const double hold = scale * sideways(result.force, normal).norm();
    const Vector3 next = (hold * d + result.slip).normalized();
    const double change = (next - d).norm();
    d = next;
    if (!(change > 1e-15)) break;
  }
  return result;
}

}  // namespace

SingleContact solve_single_contact(const Matrix3& W, const Vector3& gap, ContactLaw law,
                                   const Vector3& normal, const Friction& friction) noexcept {
  if (law == ContactLaw::kReleased) return {};
  if (law == ContactLaw::kTouching && gap.dot(normal) >= 0) return {};
  const Vector3 stick = W.ldlt().solve(gap);
  if (law == ContactLaw::kHeld) return {stick, ContactMode::kSticking, Vector3::Zero()};
  const double push = -stick.dot(normal);
  const double along = sideways(stick, normal).norm();
  if (push >= 0 && (std::isinf(friction.static_) || along <= friction.static_ * push)) {
    return {stick, ContactMode::kSticking, Vector3::Zero()};
  }
  if (std::isinf(friction.kinetic)) return {};  // would have to be pulled, and cannot slip
  if (friction.kinetic == 0.0 || along == 0.0) {
    SingleContact result;
    result.mode = ContactMode::kSlipping;
    result.force = force_towards(W, gap, normal, 0.0, Vector3::Zero());
    result.slip = sideways(gap - W * result.force, normal);
    return result;
  }
  return slip(W, gap, normal, friction.kinetic, stick);
}

}  // namespace irdm
