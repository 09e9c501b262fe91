#include "common/motion/free_motion.hpp"

#include <cmath>

namespace irdm {
namespace {

// The rotation vector of a rotation, |v| at most pi.
Vector3 rotation_vector(const Quaternion& q) noexcept {
  const Quaternion short_way = q.w() < 0 ? Quaternion(-q.coeffs()) : q;
  const double sine = short_way.vec().norm();
  if (sine == 0.0) return Vector3::Zero();
  return 2.0 * std::atan2(sine, short_way.w()) / sine * short_way.vec();
}

// Half a step of damping.
void damp(const RigidBody& body, const RigidDamping& damping, RigidState& state) noexcept {
  if (damping.linear > 0) state.velocity *= std::exp(-0.5 * body.dt() * damping.linear);
  if (damping.angular > 0) state.angular_momentum *= std::exp(-0.5 * body.dt() * damping.angular);
}

}  // namespace

Vector3 free_force(double mass, const FreeForces& forces, const Vector3& position) noexcept {
  return mass * forces.gravity - forces.tether.stiffness * (position - forces.home_position);
}

Vector3 free_torque(const FreeForces& forces, const Quaternion& orientation) noexcept {
  if (!(forces.tether.angular_stiffness > 0)) return Vector3::Zero();
  return -forces.tether.angular_stiffness *
         rotation_vector(orientation * forces.home_orientation.conjugate());
}

FreeMotion free_motion(const RigidBody& body, const FreeForces& forces,
                       const RigidState& state) noexcept {
  FreeMotion motion;
  motion.start = state;
  damp(body, forces.damping, motion.start);
  motion.force =
      free_force(body.mass(), forces, state.position + 0.5 * body.dt() * motion.start.velocity);
  if (forces.tether.angular_stiffness > 0) {
    motion.torque = free_torque(forces, body.mid_step_orientation(motion.start));
  }
  const RigidState end = body.advance(motion.start, motion.force, motion.torque);
  motion.position = end.position;
  motion.orientation = end.orientation;
  return motion;
}

RigidState end_of_step(const RigidBody& body, const FreeForces& forces, const FreeMotion& motion,
                       const Vector3& force, const Vector3& torque) noexcept {
  RigidState end = body.advance(motion.start, motion.force + force, motion.torque + torque);
  damp(body, forces.damping, end);
  return end;
}

}  // namespace irdm
