#pragma once

#include "common/geometry.hpp"
#include "common/motion/rigid_body.hpp"

namespace irdm {

/// How the free motion of an object is held back, half of it before and half after what the forces
/// of a step do (Strang splitting: second order). Both act on the rigid motion alone.
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

/// Of gravity and tether on a body at `position` [N], W.
Vector3 free_force(double mass, const FreeForces& forces, const Vector3& position) noexcept;
/// Of the tether about the centre of mass of a body that stands so [N m], W.
Vector3 free_torque(const FreeForces& forces, const Quaternion& orientation) noexcept;

/// Where everything but the contacts takes the body frame by the end of a step.
struct FreeMotion {
  RigidState start;                    ///< with the velocities that half the damping leaves
  Vector3 force = Vector3::Zero();     ///< of gravity and tether during the step [N], W
  Vector3 torque = Vector3::Zero();    ///< the same about the centre of mass [N m], W
  Vector3 position = Vector3::Zero();  ///< c + dt v + dt^2/2 F/M [m], W
  Quaternion orientation = Quaternion::Identity();  ///< exp(dt w_free) Q
  /// RigidBody::mid_step_orientation() of the state.
  Quaternion halfway = Quaternion::Identity();

  /// A point of W in that frame.
  Vector3 to_body(const Vector3& x) const noexcept {
    return orientation.conjugate() * (x - position);
  }
  /// A point of that frame in W.
  Vector3 to_world(const Vector3& x) const noexcept { return position + orientation * x; }
};

/// The coming step of a body from a state. The tether's force is that half-way. Pure, real-time
/// safe.
FreeMotion free_motion(const RigidBody& body, const FreeForces& forces,
                       const RigidState& state) noexcept;

/// The state at the end of that step, in which contacts exerted `force` [N] and `torque` about the
/// centre of mass [N m] besides, both W. Pure, real-time safe.
RigidState end_of_step(const RigidBody& body, const FreeForces& forces, const FreeMotion& motion,
                       const Vector3& force, const Vector3& torque) noexcept;

}  // namespace irdm
