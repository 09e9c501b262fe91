#include "common/motion/free_motion.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {

void RigidStateHistory::Forces::add(const Vector3& force, const Vector3& arm) noexcept {
  sum += force;
  arms += arm * force.transpose();
}

// Of one force: (Q r) x F, whose components are differences of those of Q r F^T.
Vector3 RigidStateHistory::Forces::torque(const Quaternion& orientation) const noexcept {
  const Matrix3 turned = orientation.toRotationMatrix() * arms;
  return {turned(1, 2) - turned(2, 1), turned(2, 0) - turned(0, 2), turned(0, 1) - turned(1, 0)};
}

void RigidStateHistory::remember(const RigidState& before, const Quaternion& halfway,
                                 const Forces& forces, const CouplingStep& led) noexcept {
  steps_[count_++ % kKept] = {before, halfway, forces, led};
}

void RigidStateHistory::add(int age, const Vector3& force, const Vector3& arm) noexcept {
  at(age).forces.add(force, arm);
  changed_ = std::max(changed_, age);
}

RigidState RigidStateHistory::replay(const RigidBody& body, const FreeForces& free,
                                     const RigidState& state) noexcept {
  if (changed_ < 0) return state;
  RigidState now = at(changed_).before;
  for (int age = changed_; age >= 0; --age) {
    Step& step = at(age);
    step.before = now;
    const FreeMotion motion = free_motion(body, free, now, step.led);
    step.halfway = motion.halfway;
    const Vector3 torque = step.forces.torque(step.halfway);
    now = end_of_step(body, free, motion, step.forces.sum, torque, step.led).state;
  }
  changed_ = -1;
  return now;
}

namespace {

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

FreeMotion free_motion(const RigidBody& body, const FreeForces& forces, const RigidState& state,
                       const CouplingStep& led) noexcept {
  FreeMotion motion;
  motion.start = state;
  if (led.any()) motion.damper = led.coupling->damp(led.home, body, motion.start, motion.work);
  damp(body, forces.damping, motion.start);
  const Vector3 middle = state.position + 0.5 * body.dt() * motion.start.velocity;
  motion.force = free_force(body.mass(), forces, middle);
  const bool spins_freely = !(forces.tether.angular_stiffness > 0) &&
                            !(forces.damping.angular > 0) && body.moves() && !led.any();
  if (spins_freely) {  // one angular velocity for both
    const Quaternion& Q = state.orientation;
    const Vector3 w = body.step_angular_velocity(Q, state.angular_momentum);
    motion.halfway = (rotation_from_vector(0.5 * body.dt() * w) * Q).normalized();
    motion.orientation = (rotation_from_vector(body.dt() * w) * Q).normalized();
    motion.position = body.moved(motion.start, motion.force);
    return motion;
  }
  motion.halfway = body.mid_step_orientation(state);
  const Quaternion turned = body.mid_step_orientation(motion.start);
  motion.torque = free_torque(forces, turned);
  if (led.any()) {
    motion.spring = led.coupling->spring(led.home, middle, turned);
    motion.spring_arm = turned * led.coupling->reference();
    motion.force += motion.spring.force;
    motion.torque += motion.spring_torque();
  }
  const RigidState end = body.advance(motion.start, motion.force, motion.torque);
  motion.position = end.position;
  motion.orientation = end.orientation;
  return motion;
}

double rigid_energy(const RigidBody& body, const FreeForces& forces,
                    const RigidState& state) noexcept {
  if (!body.moves()) return 0.0;
  const Tether& tether = forces.tether;
  const Vector3 turned =
      tether.angular_stiffness > 0
          ? rotation_vector(state.orientation * forces.home_orientation.conjugate())
          : Vector3::Zero();
  return 0.5 * (body.mass() * state.velocity.squaredNorm() +
                state.angular_momentum.dot(body.angular_velocity(state)) +
                tether.stiffness * (state.position - forces.home_position).squaredNorm() +
                tether.angular_stiffness * turned.squaredNorm()) -
         body.mass() * forces.gravity.dot(state.position);
}

RigidState end_of_step(const RigidBody& body, const FreeForces& forces, const FreeMotion& motion,
                       const Vector3& force, const Vector3& torque) noexcept {
  RigidState end = body.advance(motion.start, motion.force + force, motion.torque + torque);
  damp(body, forces.damping, end);
  return end;
}

LedStep end_of_step(const RigidBody& body, const FreeForces& forces, const FreeMotion& motion,
                    const Vector3& force, const Vector3& torque, const CouplingStep& led) noexcept {
  LedStep step;
  step.state = end_of_step(body, forces, motion, force, torque);
  if (!led.any()) return step;
  const Vector3 turn =
      0.5 * body.dt() * (body.angular_velocity(motion.start) + body.angular_velocity(step.state));
  step.work = motion.work + motion.spring.force.dot(step.state.position - motion.start.position) +
              motion.spring_torque().dot(turn);
  const Wrench last = led.coupling->damp(led.home, body, step.state, step.work);
  step.coupling.force = motion.spring.force + 0.5 * (motion.damper.force + last.force);
  step.coupling.torque = motion.spring.torque + 0.5 * (motion.damper.torque + last.torque);
  return step;
}

}  // namespace irdm
