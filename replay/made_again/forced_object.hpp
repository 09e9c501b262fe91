#pragma once

#include <memory>
#include <vector>

#include "common/motion/rigid_past.hpp"
#include "server/step/recorded_forces.hpp"
#include "server/step/simulation_config.hpp"

namespace irdm::replay {

/// One object under the forces that a trace has of it, as they stand in B: they deform it and move
/// it, each with the lever arm of the point that it acts on as the engine has it here. Nothing is
/// solved. Pure; one thread.
class ForcedObject {
 public:
  /// @param config of the scene, for its styluses  @param number of the object in it
  ForcedObject(const SimulationConfig& config, std::size_t number);

  void reset();
  /// Before the step: a force that belonged to an earlier one.
  void enter_late(const LateForce& late);
  /// From the next step on.
  void set(const Vector3& gravity, const ObjectSettings& settings);
  /// @param again the contacts and the floor's forces of the recorded step; the motion is written
  void step(ObjectRecord& again);

  const ResponseEngine& engine() const { return *engine_; }

 private:
  Vector3 place(const ContactPatch& patch) const;
  RigidPast::Forces collect(const ObjectRecord& recorded);

  std::shared_ptr<const Model> model_;
  RigidBody body_;
  std::unique_ptr<ResponseEngine> engine_;
  RestSurface surface_;
  std::vector<PressureMask> masks_;
  RecordedForces forces_;
  RigidPast past_;
  RigidState start_;
  RigidState state_;
  FreeForces free_forces_;
  bool feels_spin_;
  double material_damping_ = 1.0;
  ContactPatch patch_;
};

}  // namespace irdm::replay
