#pragma once

#include <array>
#include <cstdint>

#include "common/motion/free_motion.hpp"

namespace irdm {

/// The last steps of a rigid motion, so that a force that is heard of late can be entered in its
/// own step: from there on the motion is made again. Forces keep their direction in W and their
/// points in B. Pure, real-time safe.
class RigidStateHistory {
 public:
  static constexpr int kKept = 64;  ///< [steps]

  /// The contact forces of one step.
  struct Forces {
    Vector3 sum = Vector3::Zero();   ///< [N], W
    Matrix3 arms = Matrix3::Zero();  ///< sum of arm (B) times force (W) transposed [N m]

    /// @param force [N], W  @param arm from the centre of mass to where it acts [m], B
    void add(const Vector3& force, const Vector3& arm) noexcept;
    /// About the centre of mass of a body that stands so [N m], W.
    Vector3 torque(const Quaternion& orientation) const noexcept;
  };

  /// Nothing has happened yet.
  void clear() noexcept {
    count_ = 0;
    changed_ = -1;
  }
  /// A step from `before` under these contact forces.
  /// @param halfway RigidBody::mid_step_orientation(before)
  void remember(const RigidState& before, const Quaternion& halfway, const Forces& forces) noexcept;
  /// How many steps are known, at most kKept.
  int count() const noexcept { return static_cast<int>(count_ < kKept ? count_ : kKept); }
  /// Half-way through the step `age` steps before the last one, 0 <= age < count().
  const Quaternion& halfway(int age) const noexcept { return at(age).halfway; }

  /// One more force in the step `age` steps before the last one, 0 <= age < count().
  /// @param force [N], W  @param arm [m], B
  void add(int age, const Vector3& force, const Vector3& arm) noexcept;
  /// Whether there is anything that replay() has to do.
  bool changed() const noexcept { return changed_ >= 0; }
  /// The state after the last step with all that was added.
  /// @param free as they are now, all along  @param state as it is without
  RigidState replay(const RigidBody& body, const FreeForces& free,
                    const RigidState& state) noexcept;

 private:
  struct Step {
    RigidState before;
    Quaternion halfway = Quaternion::Identity();
    Forces forces;
  };
  const Step& at(int age) const noexcept {
    return steps_[(count_ - 1 - static_cast<std::uint64_t>(age)) % kKept];
  }
  Step& at(int age) noexcept {
    return steps_[(count_ - 1 - static_cast<std::uint64_t>(age)) % kKept];
  }

  std::array<Step, kKept> steps_;
  std::uint64_t count_ = 0;  ///< steps since clear()
  int changed_ = -1;         ///< age of the oldest step with something added; -1: none
};

}  // namespace irdm
