#include "precompute/check/rigid_answer.hpp"

namespace irdm::precompute {

Matrix3 rigid_mobility(const BodyProperties& body, const Vector3& at, const Vector3& from) {
  if (body.support == Support::kFixed) return Matrix3::Zero();
  return Matrix3::Identity() / body.mass - skew(at) * body.inertia.inverse() * skew(from);
}

}  // namespace irdm::precompute
