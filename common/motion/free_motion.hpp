#pragma once

#include "common/geometry.hpp"
#include "common/motion/rigid_body.hpp"

namespace irdm {

/// How the free motion of an object is held back. Both act on the rigid motion alone.
struct RigidDamping {
  double linear = 0.0;   ///< velocity decays with this rate [1/s]; times dt at most 0.5
  double angular = 0.0;  ///< angular momentum decays with this rate [1/s]; times dt at most 0.5

  bool operator==(const RigidDamping&) const = default;
};

/// A soft spring from the object to its pose at the start. 0: none.
struct Tether {
  double stiffness = 0.0;          ///< [N/m]; times dt^2 at most the mass
  double angular_stiffness = 0.0;  ///< [N m/rad]; times dt^2 at most the least moment of inertia

  bool operator==(const Tether&) const = default;
};

/// All that acts on an object but contacts.
struct FreeForces {
  Vector3 gravity = Vector3::Zero();  ///< [m/s^2], W
  RigidDamping damping;
  Tether tether;
  Vector3 home_position = Vector3::Zero();               ///< of the tether [m], W
  Quaternion home_orientation = Quaternion::Identity();  ///< of the tether, B to W
};

/// Where everything but the contacts takes the body frame by the end of a step.
struct FreeMotion {
  Vector3 force = Vector3::Zero();                  ///< of gravity, damping, tether [N], W
  Vector3 torque = Vector3::Zero();                 ///< about the centre of mass [N m], W
  Vector3 position = Vector3::Zero();               ///< c + dt v_free [m], W
  Quaternion orientation = Quaternion::Identity();  ///< exp(dt w_free) Q

  /// A point of W in that frame.
  Vector3 to_body(const Vector3& x) const noexcept {
    return orientation.conjugate() * (x - position);
  }
  /// A point of that frame in W.
  Vector3 to_world(const Vector3& x) const noexcept { return position + orientation * x; }
};

/// The coming step of a body from a state, under these forces as they are in that state. Pure,
/// real-time safe.
FreeMotion free_motion(const RigidBody& body, const FreeForces& forces,
                       const RigidState& state) noexcept;

}  // namespace irdm
