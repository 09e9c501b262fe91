#pragma once

#include <array>
#include <span>

#include "common/contact/contact_problem.hpp"
#include "server/engine/response_engine.hpp"
#include "server/step/step_record.hpp"

namespace irdm {

/// The forces of one step spread over nodes; no memory taken.
class NodalForces {
 public:
  /// Spreads a force on the object [N, B] over the nodes of its point.
  void add(const SurfacePoint& point, const Vector3& force) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      if (point.weights[i] != 0.0) forces_[count_++] = {point.nodes[i], point.weights[i] * force};
    }
  }
  std::span<const NodalForce> view() const noexcept { return {forces_.data(), count_}; }

 private:
  std::array<NodalForce, 3 * kMaxContacts> forces_;  ///< at most three nodes a contact
  std::size_t count_ = 0;
};

/// The forces that acted on the object in a recorded step.
inline NodalForces nodal_forces(const StepRecord& record) noexcept {
  NodalForces forces;
  for (std::size_t s = 0; s < static_cast<std::size_t>(record.stylus_count); ++s) {
    const StylusRecord& stylus = record.stylus[s];
    if (stylus.contact != ContactState::kFree) forces.add(stylus.point, stylus.force_on_object);
  }
  return forces;
}

}  // namespace irdm
