#include "simulation/step/object_sampling.hpp"

#include <variant>

namespace irdm {

std::unique_ptr<ContactSampling> make_sampling(const SimulationConfig& config, const Model& model,
                                               const RestSurface& surface) {
  auto sampling = std::make_unique<ContactSampling>(surface, config.contact_samples);
  if (is_rigid(model)) return sampling;
  for (const SimulationStylus& stylus : config.styluses) {
    if (stylus.ball) sampling->add_ball(model.mesh, stylus.radius);
  }
  if (!touches_others(config)) return sampling;
  const bool fixed = model.body.support == Support::kFixed;
  for (const SceneryConfig& scenery : config.scenery) {
    if (fixed && !scenery.motion.any()) continue;  // they never touch
    const SphereShape* const ball = std::get_if<SphereShape>(&scenery.shape);
    if (ball != nullptr) sampling->add_ball(model.mesh, ball->radius);
  }
  return sampling;
}

}  // namespace irdm
