#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/contact/applied_forces.hpp"
#include "common/contact/contact_problem.hpp"
#include "common/geometry.hpp"
#include "common/model/model.hpp"
#include "common/motion/free_motion.hpp"
#include "common/motion/pose_coupling.hpp"
#include "simulation/collision/scenery.hpp"
#include "simulation/engine/response_engine.hpp"

namespace irdm {

/// One object at the start.
struct SimulationObject {
  std::shared_ptr<const Model> model;
  Vector3 position = Vector3::Zero();               ///< of the centre of mass [m], W
  Quaternion orientation = Quaternion::Identity();  ///< B to W
  Vector3 velocity = Vector3::Zero();               ///< [m/s], W
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s], W
  Friction friction;                                ///< of tips on its surface
  RigidDamping damping;
  Tether tether;
  /// Centrifugal loading of the elastic part by the body's own spin. false: none, as in the paper.
  bool inertial_loading = false;
  std::string name = {};          ///< in messages; empty: "object 1" and so on
  double material_damping = 1.0;  ///< at the start, times the model's
};

/// A plane on which objects rest; the side that the normal points to is free.
struct FloorConfig {
  Vector3 normal = Vector3(0, 1, 0);  ///< unit, W
  double height = 0.0;                ///< n . x of its points [m]
  Friction friction{0.5, 0.5};
};

/// A tool: the object that a stylus leads through a coupling at the object's reference point, the
/// origin of its input mesh.
struct ToolCoupling {
  int object = 0;  ///< that floats, and that no other stylus leads
  CouplingConstants constants;
};

/// How one stylus touches.
struct SimulationStylus {
  double radius = 0.0;              ///< of the fingertip or the ball [m]; 0: a point
  double coupling_stiffness = 0.0;  ///< k_vc, spring between tip and surface [N/m]; 0: none (rigid)
  double reach = 0.0;  ///< pressed within it, the grab button holds the nearest node [m]
  /// Its bridge, if the contact is solved there, makes it exert at most this [N], > 0.
  double max_force = kMostAppliedForce;
  /// True if the tip is a rigid ball of `radius` > 0 about the position of the stylus. False for a
  /// fingertip: a patch of prescribed pressure on the surface nearest to the tip.
  bool ball = false;
  /// It leads a tool, and makes no contact of its own; what is above means nothing then.
  std::optional<ToolCoupling> tool = {};

  bool has_ball() const noexcept { return ball && !tool; }
};

/// Objects among their styluses. All models have the same dt.
struct SimulationConfig {
  Vector3 gravity = Vector3::Zero();  ///< [m/s^2], W
  std::vector<SimulationObject> objects;
  std::vector<SimulationStylus> styluses{1};
  std::optional<FloorConfig> floor;
  double release_time = 0.03;          ///< in which a held point that pulls is given up [s]
  std::vector<SceneryConfig> scenery;  ///< at most kMaxScenery
  /// Whether objects touch each other and scenery.
  bool between_objects = true;
  /// Whether parts of one object touch each other, where they face each other at rest.
  bool self_contact = false;
  int contact_samples = 384;  ///< of an object's surface, for such contacts, > 0
  double sleep_time = 0.0;    ///< at rest, after which objects sleep [s]; 0: never
};

/// What messages call object i: object "NAME", or object 1, 2, ...
inline std::string object_name(const SimulationConfig& config, std::size_t i) {
  const std::string& name = config.objects[i].name;
  return "object " + (name.empty() ? std::to_string(i + 1) : "\"" + name + "\"");
}

/// Whether objects of the scene can touch each other or scenery.
inline bool touches_others(const SimulationConfig& config) {
  return config.between_objects && (config.objects.size() > 1 || !config.scenery.empty());
}

/// Returns whether the tip of any stylus is a ball.
inline bool has_balls(const SimulationConfig& config) {
  return std::any_of(config.styluses.begin(), config.styluses.end(),
                     [](const SimulationStylus& stylus) { return stylus.has_ball(); });
}

/// Returns whether a step can have contacts in BodyContactRecord: of objects with each other, with
/// scenery, with balls of styluses, or of parts of one object.
inline bool touches_bodies(const SimulationConfig& config) {
  return config.self_contact || touches_others(config) || has_balls(config);
}

/// Returns the number of the ball of stylus s in BodyContactRecord::other.
inline int ball_number(const SimulationConfig& config, std::size_t s) {
  return -1 - static_cast<int>(config.scenery.size() + s);
}

/// Returns the stylus of a ball by its number in BodyContactRecord::other; -1 if it is not one.
inline int stylus_of_ball(const SimulationConfig& config, int other) {
  return other < 0 ? std::max(-1, -1 - other - static_cast<int>(config.scenery.size())) : -1;
}

/// The styluses that lead a tool.
inline std::vector<int> tool_styluses(const SimulationConfig& config) {
  std::vector<int> leading;
  for (std::size_t s = 0; s < config.styluses.size(); ++s) {
    if (config.styluses[s].tool) leading.push_back(static_cast<int>(s));
  }
  return leading;
}

}  // namespace irdm
