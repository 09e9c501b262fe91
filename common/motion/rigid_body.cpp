#include "common/motion/rigid_body.hpp"

#include <cmath>

namespace irdm {

Quaternion rotation_from_vector(const Vector3& v) noexcept {
  const double half = 0.5 * v.norm();
  // sin(half) / |v|, by its series where the quotient would lose digits.
  const double scale = half < 1e-4 ? 0.5 - half * half / 12.0 : 0.5 * std::sin(half) / half;
  const Vector3 xyz = scale * v;
  return {std::cos(half), xyz.x(), xyz.y(), xyz.z()};
}

Vector3 rotation_vector(const Quaternion& q) noexcept {
  const Quaternion short_way = q.w() < 0 ? Quaternion(-q.coeffs()) : q;
  const double sine = short_way.vec().norm();
  if (sine == 0.0) return Vector3::Zero();
  return 2.0 * std::atan2(sine, short_way.w()) / sine * short_way.vec();
}

RigidBody::RigidBody(const BodyProperties& properties, double dt)
    : mass_(properties.mass),
      inertia_(properties.inertia),
      inverse_inertia_(properties.inertia.inverse()),
      dt_(dt),
      moves_(properties.support == Support::kFloating) {}

Vector3 RigidBody::step_angular_velocity(const Quaternion& orientation,
                                         const Vector3& angular_momentum) const noexcept {
  // Fixed point of w = Q_half I^-1 Q_half^T L with Q_half = exp(dt/2 w) Q. Each round gains a
  // factor of about dt |w|; a fixed number keeps the cost bounded.
  constexpr int kRounds = 4;
  Vector3 w = Vector3::Zero();
  for (int round = 0; round <= kRounds; ++round) {
    const Quaternion half = rotation_from_vector(0.5 * dt_ * w) * orientation;
    w = half * (inverse_inertia_ * (half.conjugate() * angular_momentum));
  }
  return w;
}

RigidState RigidBody::advance(const RigidState& state, const Vector3& force,
                              const Vector3& torque) const noexcept {
  if (!moves_) return state;
  RigidState next;
  next.velocity = state.velocity + dt_ / mass_ * force;
  next.position = moved(state, force);
  next.angular_momentum = state.angular_momentum + dt_ * torque;
  const Vector3 w =
      step_angular_velocity(state.orientation, state.angular_momentum + 0.5 * dt_ * torque);
  next.orientation = (rotation_from_vector(dt_ * w) * state.orientation).normalized();
  return next;
}

RigidState RigidBody::with_past(const RigidState& state, const Vector3& force,
                                const Vector3& torque, int age) const noexcept {
  if (!moves_) return state;
  RigidState late = state;
  const double since = (age + 0.5) * dt_;
  late.velocity += dt_ / mass_ * force;
  late.position += since * dt_ / mass_ * force;
  late.angular_momentum += dt_ * torque;
  const Quaternion& Q = state.orientation;
  const Vector3 w = Q * (inverse_inertia_ * (Q.conjugate() * (dt_ * torque)));
  late.orientation = (rotation_from_vector(since * w) * Q).normalized();
  return late;
}

Vector3 RigidBody::mid_step_spin(const RigidState& state) const noexcept {
  if (!moves_) return Vector3::Zero();
  return inverse_inertia_ * (mid_step_orientation(state).conjugate() * state.angular_momentum);
}

Quaternion RigidBody::mid_step_orientation(const RigidState& state) const noexcept {
  if (!moves_) return state.orientation;
  const Vector3 w = step_angular_velocity(state.orientation, state.angular_momentum);
  return (rotation_from_vector(0.5 * dt_ * w) * state.orientation).normalized();
}

Vector3 RigidBody::angular_velocity(const RigidState& state) const noexcept {
  const Quaternion& Q = state.orientation;
  return Q * (inverse_inertia_ * (Q.conjugate() * state.angular_momentum));
}

Vector3 RigidBody::angular_momentum(const Quaternion& orientation,
                                    const Vector3& angular_velocity) const noexcept {
  return orientation * (inertia_ * (orientation.conjugate() * angular_velocity));
}

RigidMobility RigidBody::mobility() const noexcept {
  if (!moves_) return {};
  return {0.5 * dt_ * dt_ / mass_, 0.5 * dt_ * dt_ * inverse_inertia_};
}

}  // namespace irdm
