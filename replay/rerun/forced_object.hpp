#pragma once

#include <vector>

#include "replay/rerun/forced_body.hpp"
#include "simulation/step/deformable_body.hpp"
#include "simulation/step/nodal_forces.hpp"

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
  void displacement(Points& u) const override { body_.engine().displacement(u); }

 private:
  Vector3 place(const ContactPatch& patch) const;
  RigidStateHistory::Forces collect(const ObjectRecord& recorded);

  DeformableBody body_;
  RestSurface surface_;
  std::vector<PressureMask> masks_;
  RecordedForces forces_;
  ContactPatch patch_;
};

}  // namespace irdm::replay
