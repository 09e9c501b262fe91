#include "simulation/step/gravity_load.hpp"

namespace irdm {

void follow_gravity(ResponseEngine& engine, const SimulationObject& object,
                    const Vector3& gravity) noexcept {
  GravityLoading* const loading = engine.capabilities().gravity;
  if (object.model->body.support == Support::kFloating || loading == nullptr) return;
  loading->set_gravity(object.orientation.normalized().conjugate() * gravity);
}

bool takes_gravity(const SimulationObject& object) {
  return object.model->body.support == Support::kFloating || has_gravity(*object.model);
}

}  // namespace irdm
