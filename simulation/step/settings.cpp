#include "simulation/step/settings.hpp"

#include <algorithm>
#include <string>

#include "common/dense_algebra.hpp"
#include "common/error.hpp"
#include "common/number_text.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm {

void follow_gravity(ResponseEngine& engine, const SimulationObject& object,
                    const Vector3& gravity) noexcept {
  GravityLoading* const loading = engine.capabilities().gravity;
  if (object.model->body.support == Support::kFloating || loading == nullptr) return;
  loading->set_gravity(object.orientation.normalized().conjugate() * gravity);
}

bool takes_gravity(const SimulationObject& object) {
  const Model& model = *object.model;
  return model.body.support == Support::kFloating || is_rigid(model) || has_gravity(model);
}

void check_inertial_loading(const Model& model, bool inertial_loading, const std::string& where) {
  if (!has_inertial_loading(model, inertial_loading) || has_centrifugal(model)) return;
  if (is_rigid(model)) {
    throw Error(where, "is of a rigid body, which inertial_loading cannot bend",
                "leave inertial_loading out");
  }
  const bool dense = !std::holds_alternative<ModalResponse>(model.response);
  throw Error(where,
              std::string("has no centrifugal response for engine = \"") +
                  (dense ? "dense" : "modal") + "\", which inertial_loading needs",
              "precompute it again with method = \"modal\", or leave inertial_loading out");
}

namespace {

// Damping and tether act as they were at the start of a step: stable as long as a step is short for
// them.
void check_restraints(const Model& model, const ObjectSettings& settings, const std::string& name) {
  if (model.body.support == Support::kFixed) return;  // it does not move at all
  const double dt = model.dt;
  if (std::max(settings.damping.linear, settings.damping.angular) * dt > 0.5) {
    throw Error(name,
                "has a damping that is too strong for its model's dt of " + number_text(dt) + " s",
                "use at most " + number_text(0.5 / dt) + " 1/s");
  }
  const double inertia = symmetric_eigenvalues(model.body.inertia)(0);
  const double stiffest = model.body.mass / (dt * dt);
  const double stiffest_angular = inertia / (dt * dt);
  if (settings.tether.stiffness > stiffest ||
      settings.tether.angular_stiffness > stiffest_angular) {
    throw Error(name, "has a tether that is too stiff for its mass and its model's dt",
                "use at most " + number_text(stiffest) + " N/m and " +
                    number_text(stiffest_angular) + " N m/rad");
  }
}

}  // namespace

void check_restraints(const SimulationConfig& config, const Settings& settings) {
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    check_restraints(*config.objects[i].model, settings.object[i], object_name(config, i));
  }
}

namespace {

[[noreturn]] void refuse_material_damping(const SimulationConfig& config, std::size_t i) {
  throw Error(object_name(config, i),
              "cannot change the damping of its material while it is simulated",
              "use engine = \"modal\" and no floor, or precompute it again");
}

void check_choice(const SimulationConfig& config, std::size_t i, const ObjectSettings& initial,
                  const ObjectSettings& settings) {
  const SettingsChoice choice = settings_choice(config, i);
  if (!choice.material_damping && settings.material_damping != initial.material_damping) {
    refuse_material_damping(config, i);
  }
  if (!choice.inertial_loading && settings.inertial_loading != initial.inertial_loading) {
    throw Error(object_name(config, i), "has a model that does not say what its spin does",
                "precompute it again with method = \"modal\"");
  }
}

}  // namespace

Settings initial_settings(const SimulationConfig& config) {
  Settings settings;
  settings.gravity = config.gravity;
  for (std::size_t i = 0; i < config.objects.size() && i < settings.object.size(); ++i) {
    const SimulationObject& object = config.objects[i];
    settings.object[i] = {object.friction, object.damping, object.tether, object.material_damping,
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
  choice.motion = floats;
  return choice;
}

void check_material_damping(const SimulationConfig& config) {
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    if (config.objects[i].material_damping == 1.0) continue;
    if (!settings_choice(config, i).material_damping) refuse_material_damping(config, i);
  }
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
    check_choice(config, i, initial.object[i], settings.object[i]);
  }
  check_restraints(config, settings);
}

}  // namespace irdm
