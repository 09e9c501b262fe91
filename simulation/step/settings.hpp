#pragma once

#include <array>
#include <string>

#include "common/model/model.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm {

/// Makes gravity bend an object as it is set [m/s^2], W. Only a fixed one, which stays as it stood
/// at the start: gravity alone does not bend what floats, and what it rests on or hangs from does
/// so by its force. Real-time safe.
/// @param engine of the object
void follow_gravity(ResponseEngine& engine, const SimulationObject& object,
                    const Vector3& gravity) noexcept;

/// Whether gravity can bend the object as far as that is up to it: it floats, is rigid, or its
/// response says what gravity does to it.
bool takes_gravity(const SimulationObject& object);

/// Whether the body's own spin is to load its elastic part. A fixed body has none.
inline bool has_inertial_loading(const Model& model, bool inertial_loading) {
  return inertial_loading && model.body.support == Support::kFloating;
}

/// Throws Error, naming `where` (the model file), when the model cannot say what its spin does.
void check_inertial_loading(const Model& model, bool inertial_loading, const std::string& where);

inline constexpr int kMaxObjects = 16;

/// What of one object can be changed while it is simulated.
struct ObjectSettings {
  Friction friction;
  RigidDamping damping;
  Tether tether;
  double material_damping = 1.0;  ///< times that of the model, 0.1..10
  bool inertial_loading = false;

  bool operator==(const ObjectSettings&) const = default;
};

/// What of a scene can be changed while it is simulated. Objects beyond the scene's mean nothing.
struct Settings {
  Vector3 gravity = Vector3::Zero();  ///< [m/s^2], W
  std::array<ObjectSettings, kMaxObjects> object;

  bool operator==(const Settings&) const = default;
};

/// Which settings of an object are more than a number of the step.
struct SettingsChoice {
  bool material_damping = false;  ///< a dense response has its damping in it; a floor relies on it
  bool inertial_loading = false;  ///< its model says what spin does, and it can turn
  bool motion = true;             ///< damping and tether: it floats

  bool operator==(const SettingsChoice&) const = default;
};

/// The settings that a scene begins with.
Settings initial_settings(const SimulationConfig& config);

/// What can be chosen for object i.
SettingsChoice settings_choice(const SimulationConfig& config, std::size_t i);

/// Throws Error where an object begins with another damping of its material than its model's and
/// cannot have one.
void check_material_damping(const SimulationConfig& config);

/// Makes an engine work as set. Real-time safe. @param material_damping that it works with, kept
/// by whoever owns the engine
void follow_settings(ResponseEngine& engine, const ObjectSettings& settings,
                     double& material_damping) noexcept;

/// Throws Error when the step of the scene cannot bear these settings: something that cannot be
/// chosen differs from the beginning, or a damping or tether is too strong for dt.
void check_settings(const SimulationConfig& config, const Settings& settings);

/// Throws Error when a damping or tether is too strong for the step's dt: both act as they were at
/// its start.
void check_restraints(const SimulationConfig& config, const Settings& settings);

}  // namespace irdm
