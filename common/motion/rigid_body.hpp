#pragma once

#include "common/contact/contact_problem.hpp"
#include "common/geometry.hpp"
#include "common/model/model.hpp"

namespace irdm {

/// Pose and motion of the object's body frame B in W.
struct RigidState {
  Vector3 position = Vector3::Zero();               ///< c, centre of mass [m], W
  Quaternion orientation = Quaternion::Identity();  ///< Q, unit, B to W
  Vector3 velocity = Vector3::Zero();               ///< v [m/s], W
  /// I w [kg m^2/s], W. Kept instead of w so that a free body keeps it exactly.
  Vector3 angular_momentum = Vector3::Zero();
};

/// Rigid motion by equations (1)(2), M dv/dt = sum F and I dw/dt + w x (I w) = sum tau, one step of
/// dt at a time, for forces that are held during the step, as those of R are: translation exactly,
/// c += dt v + dt^2/2 F/M, and rotation to second order, by the angular velocity half-way with half
/// the step's torque (implicit midpoint on the rotation group; the energy of a free spin does not
/// drift). Momentum and angular momentum change by exactly the impulses applied. A fixed object
/// does not move. Pure and real-time safe.
class RigidBody {
 public:
  /// @param dt step [s], > 0
  RigidBody(const BodyProperties& properties, double dt);

  /// The state after a step in which `force` [N] and `torque` about the centre of mass [N m], both
  /// W, acted throughout.
  RigidState advance(const RigidState& state, const Vector3& force,
                     const Vector3& torque) const noexcept;

  /// The position at the end of that step [m], W; of a body that moves.
  Vector3 moved(const RigidState& state, const Vector3& force) const noexcept {
    return state.position + 0.5 * dt_ * (state.velocity + (state.velocity + dt_ / mass_ * force));
  }

  /// The state as it would be, to first order, had `force` [N] and `torque` [N m], both W, acted
  /// besides during the step `age` steps before the last one (0: the last one itself).
  RigidState with_past(const RigidState& state, const Vector3& force, const Vector3& torque,
                       int age) const noexcept;
  /// Angular velocity that carries a body of this orientation through the coming step [rad/s], W.
  /// @param angular_momentum half-way through the step [kg m^2/s], W
  Vector3 step_angular_velocity(const Quaternion& orientation,
                                const Vector3& angular_momentum) const noexcept;

  /// The same without torque in B as the body stands half-way through that step [rad/s]: the spin
  /// that loads the elastic part. Zero when fixed.
  Vector3 mid_step_spin(const RigidState& state) const noexcept;

  /// How the body stands half-way through the coming step without torque, B to W. Contact forces,
  /// which are held in B, have their direction in W by it.
  Quaternion mid_step_orientation(const RigidState& state) const noexcept;

  /// Instantaneous angular velocity [rad/s], W.
  Vector3 angular_velocity(const RigidState& state) const noexcept;

  /// Angular momentum of a body that turns with `angular_velocity` [rad/s], W.
  Vector3 angular_momentum(const Quaternion& orientation,
                           const Vector3& angular_velocity) const noexcept;

  /// What forces held during a step move by its end: dt^2 / 2M and dt^2/2 I_B^-1, in B. Zero when
  /// fixed.
  RigidMobility mobility() const noexcept;

  double mass() const noexcept { return mass_; }
  double dt() const noexcept { return dt_; }
  bool moves() const noexcept { return moves_; }

 private:
  double mass_;
  Matrix3 inertia_;          ///< I_B
  Matrix3 inverse_inertia_;  ///< I_B^-1
  double dt_;
  bool moves_;
};

/// The rotation by |v| about v.
Quaternion rotation_from_vector(const Vector3& v) noexcept;
/// The rotation vector of a rotation, |v| at most pi.
Vector3 rotation_vector(const Quaternion& q) noexcept;

}  // namespace irdm
