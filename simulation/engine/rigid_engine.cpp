#include "simulation/engine/rigid_engine.hpp"

#include <algorithm>

namespace irdm {

Vector3 RigidEngine::free_displacement(int /*node*/) const noexcept {
  return Vector3::Zero();
}

void RigidEngine::predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
                          ContactMatrix& compliance) noexcept {
  const auto size = static_cast<Eigen::Index>(3 * patches.size());
  std::fill_n(h.begin(), patches.size(), Vector3::Zero());
  compliance.setZero(size, size);
}

void RigidEngine::predict_horizon(const ContactPatch& /*patch*/,
                                  std::span<const NodalForce> /*held*/, std::span<Vector3> path,
                                  std::span<Matrix3> response) noexcept {
  std::fill(path.begin(), path.end(), Vector3::Zero());
  std::fill(response.begin(), response.end(), Matrix3::Zero());
}

void RigidEngine::cross_response(const ContactPatch& /*to*/, const ContactPatch& /*from*/,
                                 std::span<Matrix3> response) noexcept {
  std::fill(response.begin(), response.end(), Matrix3::Zero());
}

void RigidEngine::add_delayed_force(std::span<const NodalForce> /*forces*/, int /*age*/) noexcept {}

void RigidEngine::advance(std::span<const NodalForce> /*forces*/) noexcept {}

void RigidEngine::displacement(Points& u, double /*tolerance*/) const {
  u.setZero(surface_nodes_, 3);
}

}  // namespace irdm
