#pragma once

#include <memory>
#include <vector>

#include "common/motion/rigid_state_history.hpp"
#include "replay/rerun/forced_body.hpp"
#include "simulation/step/recorded_forces.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm::replay {

/// By its response: the forces as they stand in B, each with the lever arm of the point that it
/// acts on as the engine has it here. Nothing is solved.
class ForcedObject final : public ForcedBody {
 public:
  /// @param config of the scene, for its styluses  @param number of the object in it
  ForcedObject(const SimulationConfig& config, std::size_t number);

  void reset() override;
  void insert_delayed_force(const LateForce& late) override;
  void set(const Vector3& gravity, const ObjectSettings& settings) override;
  void step(ObjectRecord& again, std::span<const StylusRecord> styluses) override;
  void displacement(Points& u) const override { engine_->displacement(u); }

 private:
  Vector3 place(const ContactPatch& patch) const;
  RigidStateHistory::Forces collect(const ObjectRecord& recorded);

  SimulationObject object_;
  std::shared_ptr<const Model> model_;
  RigidBody body_;
  std::unique_ptr<ResponseEngine> engine_;
  RestSurface surface_;
  std::vector<PressureMask> masks_;
  RecordedForces forces_;
  RigidStateHistory past_;
  RigidState start_;
  RigidState state_;
  FreeForces free_forces_;
  bool feels_spin_;
  double material_damping_ = 1.0;
  ContactPatch patch_;
};

}  // namespace irdm::replay
