#include "common/motion/rigid_state_history.hpp"

#include <algorithm>

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
                                 const Forces& forces) noexcept {
  steps_[count_++ % kKept] = {before, halfway, forces};
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
    const FreeMotion motion = free_motion(body, free, now);
    step.halfway = motion.halfway;
    now = end_of_step(body, free, motion, step.forces.sum, step.forces.torque(step.halfway));
  }
  changed_ = -1;
  return now;
}

}  // namespace irdm
