#pragma once

#include <array>
#include <cstdint>

#include "common/geometry.hpp"
#include "common/motion/pose_coupling.hpp"
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

/// What leads a body in one step, if anything does.
struct CouplingStep {
  const PoseCoupling* coupling = nullptr;  ///< null: nothing
  CouplingHome home;

  bool any() const noexcept { return coupling != nullptr; }
};

/// Where everything but the contacts takes the body frame by the end of a step.
struct FreeMotion {
  RigidState start;                    ///< with the velocities that half the damping leaves
  Vector3 force = Vector3::Zero();     ///< of gravity and springs during the step [N], W
  Vector3 torque = Vector3::Zero();    ///< the same about the centre of mass [N m], W
  Vector3 position = Vector3::Zero();  ///< c + dt v + dt^2/2 F/M [m], W
  Quaternion orientation = Quaternion::Identity();  ///< exp(dt w_free) Q
  /// RigidBody::mid_step_orientation() of the state.
  Quaternion halfway = Quaternion::Identity();
  Wrench spring;                         ///< of the coupling, at its reference point
  Vector3 spring_arm = Vector3::Zero();  ///< where that is half-way [m], W
  Wrench damper;                         ///< of the coupling, mean over the first half of the step
  double work = 0.0;                     ///< of that damper on the body [J]

  /// Of the coupling's spring about the centre of mass [N m], W.
  Vector3 spring_torque() const noexcept { return spring.torque + spring_arm.cross(spring.force); }
  /// A point of W in that frame.
  Vector3 to_body(const Vector3& x) const noexcept {
    return orientation.conjugate() * (x - position);
  }
  /// A point of that frame in W.
  Vector3 to_world(const Vector3& x) const noexcept { return position + orientation * x; }
  /// The way of a point of the body in the step [m], W.
  Vector3 way(const Vector3& x) const noexcept {
    return to_world(x) - (start.position + start.orientation * x);
  }
};

/// The coming step of a body from a state. The forces of tether and coupling are those half-way.
/// Pure, real-time safe.
FreeMotion free_motion(const RigidBody& body, const FreeForces& forces, const RigidState& state,
                       const CouplingStep& led = {}) noexcept;

/// The state at the end of that step, in which contacts exerted `force` [N] and `torque` about the
/// centre of mass [N m] besides, both W. Pure, real-time safe.
RigidState end_of_step(const RigidBody& body, const FreeForces& forces, const FreeMotion& motion,
                       const Vector3& force, const Vector3& torque) noexcept;

/// The end of a step of a body that may be led.
struct LedStep {
  RigidState state;
  Wrench coupling;    ///< on the body at the coupling's reference point, mean over the step, W
  double work = 0.0;  ///< of the coupling on the body [J]
};

/// The same, of a body that `led` leads as it did in free_motion().
LedStep end_of_step(const RigidBody& body, const FreeForces& forces, const FreeMotion& motion,
                    const Vector3& force, const Vector3& torque, const CouplingStep& led) noexcept;

/// Kinetic energy of a state, with the potentials of gravity (0 at the origin) and tether [J]. Of a
/// fixed body: 0.
double rigid_energy(const RigidBody& body, const FreeForces& forces,
                    const RigidState& state) noexcept;

/// The last steps of a rigid motion, so that a force that is heard of late can be entered in its
/// own step: from there on the motion is computed again. Forces keep their direction in W and their
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
  void remember(const RigidState& before, const Quaternion& halfway, const Forces& forces,
                const CouplingStep& led = {}) noexcept;
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
    CouplingStep led;
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
