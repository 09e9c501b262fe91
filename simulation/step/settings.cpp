#include "simulation/step/settings.hpp"

#include <string>

#include "common/error.hpp"
#include "simulation/step/inertial_loading.hpp"
#include "simulation/step/restraints.hpp"

namespace irdm {
namespace {

void check_choice(const SettingsChoice& choice, const ObjectSettings& initial,
                  const ObjectSettings& settings, const std::string& name) {
  if (!choice.material_damping && settings.material_damping != initial.material_damping) {
    throw Error(name, "cannot change the damping of its material while it is simulated",
                "use engine = \"modal\" and no floor, or precompute it again");
  }
  if (!choice.inertial_loading && settings.inertial_loading != initial.inertial_loading) {
    throw Error(name, "has a model that does not say what its spin does",
                "precompute it again with method = \"modal\"");
  }
}

}  // namespace

Settings initial_settings(const SimulationConfig& config) {
  Settings settings;
  settings.gravity = config.gravity;
  for (std::size_t i = 0; i < config.objects.size() && i < settings.object.size(); ++i) {
    const SimulationObject& object = config.objects[i];
    settings.object[i] = {object.friction, object.damping, object.tether, 1.0,
                          object.inertial_loading};
  }
  return settings;
}

SettingsChoice settings_choice(const SimulationConfig& config, std::size_t i) {
  const SimulationObject& object = config.objects.at(i);
  const bool floats = object.model->body.support == Support::kFloating;
  SettingsChoice choice;
  choice.material_damping =
      std::holds_alternative<ModalResponse>(object.model->response) && !(config.floor && floats);
  choice.inertial_loading = floats && has_centrifugal(*object.model);
  return choice;
}

void follow_settings(ResponseEngine& engine, const ObjectSettings& settings,
                     double& material_damping) noexcept {
  if (settings.material_damping == material_damping) return;
  material_damping = settings.material_damping;
  if (MaterialDamping* const damping = engine.capabilities().damping) {
    damping->scale_damping(material_damping);
  }
}

void check_settings(const SimulationConfig& config, const Settings& settings) {
  const Settings initial = initial_settings(config);
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    check_choice(settings_choice(config, i), initial.object[i], settings.object[i],
                 "object " + std::to_string(i + 1));
  }
  check_restraints(config, settings);
}

}  // namespace irdm
