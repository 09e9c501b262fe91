#pragma once

#include <memory>
#include <span>

#include "common/motion/free_motion.hpp"
#include "common/motion/rigid_body.hpp"
#include "simulation/engine/response_engine.hpp"
#include "simulation/step/settings.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// One object without its contacts: its response, its rigid motion, and what acts on them besides
/// contacts. Each step is begin_step(), then end_step() with the contact forces that were found.
/// Real-time safe after construction; one thread.
class DeformableBody {
 public:
  /// Throws Error when the model lacks the response that its engine needs.
  DeformableBody(const SimulationObject& object, const Vector3& gravity);

  /// Back to the start, at rest under gravity as it is.
  void reset() noexcept;
  /// From the next step on. @param gravity [m/s^2], W
  void set(const Vector3& gravity, const ObjectSettings& settings) noexcept;

  /// Enters delayed forces in the motion, and begins the coming step. Start, spin and orientation
  /// half-way are written.
  void begin_step(ObjectRecord& record) noexcept;
  /// What leads the body from the coming step on.
  void lead(const CouplingStep& led) noexcept { led_ = led; }
  /// Ends it under these contact forces. The motion at its end is written.
  /// @param nodal the forces, on nodes [N], B  @param forces the same, on the body as a whole
  void end_step(std::span<const NodalForce> nodal, const RigidStateHistory::Forces& forces,
                ObjectRecord& record) noexcept;

  /// Between steps: it stands still from now on, and the record is that of a step in which it does.
  void rest(ObjectRecord& record) noexcept;

  /// Between steps: a force [N], B, acted besides at `arm` [m], B, in the step `age` steps before
  /// the last one, age < past().count(). @param nodal the same, on nodes
  void insert_delayed_force(std::span<const NodalForce> nodal, const Vector3& force,
                            const Vector3& arm, int age) noexcept;

  /// State, in or out (StateArchive). What it was led by, and forces of earlier steps that could
  /// come late, are not in it.
  void archive(StateArchive& state);

  const Model& model() const noexcept { return *object_.model; }
  ResponseEngine& engine() noexcept { return *engine_; }
  const EngineCapabilities& capabilities() const noexcept { return capabilities_; }
  const ResponseEngine& engine() const noexcept { return *engine_; }
  const RigidBody& rigid() const noexcept { return rigid_; }
  /// At the end of the last step.
  const RigidState& state() const noexcept { return state_; }
  /// Of its rigid motion, in gravity and on its tether [J].
  double energy() const noexcept { return rigid_energy(rigid_, free_forces_, state_); }
  const RigidStateHistory& past() const noexcept { return past_; }
  const FreeForces& free_forces() const noexcept { return free_forces_; }
  /// Of the step under way.
  const FreeMotion& motion() const noexcept { return motion_; }
  /// The motion of the coming step, between steps.
  FreeMotion next_motion() const noexcept {
    return free_motion(rigid_, free_forces_, state_, led_);
  }
  /// Of what led it on the body in the last step, at the coupling's reference point, W.
  const Wrench& coupling() const noexcept { return end_.coupling; }
  /// The work of that on the body [J].
  double coupling_work() const noexcept { return end_.work; }
  /// That on the body about the centre of mass, as it is at the end of the step [N m], W.
  Vector3 coupling_torque() const noexcept;

 private:
  SimulationObject object_;
  RigidBody rigid_;
  std::unique_ptr<ResponseEngine> engine_;
  EngineCapabilities capabilities_;  ///< of the engine
  double material_damping_ = 1.0;    ///< that the engine works with
  bool inertial_loading_;
  FreeForces free_forces_;
  RigidState start_;
  RigidState state_;
  RigidStateHistory past_;
  FreeMotion motion_;
  CouplingStep led_;
  LedStep end_;  ///< of the last step
};

}  // namespace irdm
