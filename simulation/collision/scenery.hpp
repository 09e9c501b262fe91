#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/contact/contact_problem.hpp"
#include "common/geometry.hpp"
#include "simulation/collision/rest_surface.hpp"

namespace irdm {

/// Through the origin of its pose; the side that the normal +y points to is free.
struct PlaneShape {};

/// Centred at the origin of its pose.
struct BoxShape {
  Vector3 size = Vector3::Zero();  ///< edges along the axes [m], > 0
};

/// Centred at the origin of its pose.
struct SphereShape {
  double radius = 0.0;  ///< [m], > 0
};

/// A cylinder about the axis y with a half ball on both ends, centred at the origin of its pose.
struct CapsuleShape {
  double radius = 0.0;  ///< [m], > 0
  double length = 0.0;  ///< between the centres of the half balls [m], >= 0
};

/// Any closed surface, hollows included; its nodes are in the frame of its pose.
struct MeshShape {
  std::shared_ptr<const RestSurface> surface;  ///< null only in a scene whose models are not read
};

using SceneryShape = std::variant<PlaneShape, BoxShape, SphereShape, CapsuleShape, MeshShape>;

/// Where scenery is at a time, from its place at the start.
struct Waypoint {
  double time = 0.0;                       ///< [s]
  Vector3 displacement = Vector3::Zero();  ///< [m], W
};

/// How scenery moves from its pose at the start, by the time t since then or since the last reset:
/// velocity t + stroke (1 - cos(2 pi frequency t)) / 2 + path(t), turned by angular_velocity t.
struct SceneryMotion {
  Vector3 velocity = Vector3::Zero();          ///< [m/s], W
  Vector3 angular_velocity = Vector3::Zero();  ///< about the origin of its pose [rad/s], W
  Vector3 stroke = Vector3::Zero();            ///< there and back in a period [m], W
  double frequency = 0.0;                      ///< of that [Hz]
  /// In the order of their times; linear between, before the first and after the last it stays.
  std::vector<Waypoint> path;

  bool any() const noexcept {
    return !path.empty() || !velocity.isZero(0.0) || !angular_velocity.isZero(0.0) ||
           (!stroke.isZero(0.0) && frequency > 0.0);
  }
};

/// A body that moves as it is told, if at all.
struct SceneryConfig {
  std::string name = "scenery";
  SceneryShape shape;
  Vector3 position = Vector3::Zero();               ///< [m], W
  Quaternion orientation = Quaternion::Identity();  ///< shape to W, unit
  Friction friction{0.5, 0.5};
  SceneryMotion motion{};
};

/// Scenery, or the ball of a stylus (StylusBall), in the current step.
struct SceneryStep {
  SceneryConfig now;                         ///< its pose is that at the end of the step
  Vector3 before = now.position;             ///< position at the start of the step [m], W
  Vector3 origin = now.position;             ///< `now.position` of the last step [m], W
  Quaternion turn = Quaternion::Identity();  ///< change of the orientation in the step, W
  Vector3 first_position = now.position;     ///< at the start [m], W
  Quaternion first_orientation = now.orientation;
  bool led = false;     ///< true for the ball of a stylus
  bool present = true;  ///< false for the ball of an absent stylus, which touches nothing
  /// Displacement of the ball of a stylus at the end of the step if no contact force acted on it,
  /// relative to `now` [m], W.
  Vector3 recoil = Vector3::Zero();

  bool moves() const noexcept { return led ? present : now.motion.any(); }
  /// Moves it to its pose at time t [s], the end of the step; 0 is the start. Real-time safe.
  void go_on(double t) noexcept;
  /// Returns the position [m, W] to which the step takes a point of the body. The argument is its
  /// true position at the start of the step.
  Vector3 moved(const Vector3& x) const noexcept {
    return moves() ? Vector3(now.position + turn * (x - before)) : x;
  }
  /// The same, but the argument is the position that contacts of the last step gave the point.
  Vector3 carried(const Vector3& x) const noexcept {
    return moves() ? Vector3(now.position + turn * (x - origin)) : x;
  }
};

inline constexpr std::size_t kMaxScenery = 16;  ///< bodies in a scene

/// A point of the surface of scenery.
struct SceneryHit {
  Vector3 position = Vector3::Zero();  ///< [m], W
  Vector3 normal = Vector3::UnitY();   ///< outward, unit, W
  double signed_distance = 0.0;        ///< from it to the query point, positive outside [m]
};

/// The point of the surface nearest to x [m, W]; where several are (centre of a sphere, axis of a
/// capsule, middle planes of a box), one of them. Within a box it is on the nearest face. Real-time
/// safe, any thread.
SceneryHit closest(const SceneryConfig& scenery, const Vector3& x) noexcept;

/// Where the way from `from` to `to` [m, W] first enters from outside, `to` included; its distance
/// is 0. On the surface is outside: a way that starts there and leads in enters there. None if
/// `from` is inside, or if the way misses or only touches. Real-time safe, any thread.
std::optional<SceneryHit> first_crossing(const SceneryConfig& scenery, const Vector3& from,
                                         const Vector3& to) noexcept;

/// Radius of the smallest ball about the origin of its pose that contains it [m]; infinite for a
/// plane.
double bounding_radius(const SceneryShape& shape) noexcept;

}  // namespace irdm
