#include "simulation/step/object_sampling.hpp"

#include <variant>

namespace irdm {

std::unique_ptr<ContactSampling> make_sampling(const SimulationConfig& config, const Model& model,
                                               const RestSurface& surface) {
  auto sampling = std::make_unique<ContactSampling>(surface, config.contact_samples);
  for (const SimulationStylus& stylus : config.styluses) {
    if (stylus.has_ball()) sampling->add_ball(model.mesh, stylus.radius);
  }
  if (is_rigid(model) || !touches_others(config)) return sampling;
  const bool fixed = model.body.support == Support::kFixed;
  for (const SceneryConfig& scenery : config.scenery) {
    if (fixed && !scenery.motion.any()) continue;  // they never touch
    const SphereShape* const ball = std::get_if<SphereShape>(&scenery.shape);
    if (ball != nullptr) sampling->add_ball(model.mesh, ball->radius);
  }
  return sampling;
}

}  // namespace irdm
