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

}  // namespace

FreeMotion free_motion(const RigidBody& body, const FreeForces& forces,
                       const RigidState& state) noexcept {
  FreeMotion motion;
  motion.force = body.mass() * (forces.gravity - forces.damping.linear * state.velocity) -
                 forces.tether.stiffness * (state.position - forces.home_position);
  motion.torque = -forces.damping.angular * state.angular_momentum;
  if (forces.tether.angular_stiffness > 0) {
    motion.torque -= forces.tether.angular_stiffness *
                     rotation_vector(state.orientation * forces.home_orientation.conjugate());
  }
  const RigidState end = body.advance(state, motion.force, motion.torque);
  motion.position = end.position;
  motion.orientation = end.orientation;
  return motion;
}

}  // namespace irdm
