#pragma once

#include <optional>
#include <span>
#include <vector>

#include "replay/rerun/touch_forces.hpp"
#include "simulation/step/deformable_body.hpp"
#include "simulation/step/nodal_forces.hpp"
#include "simulation/step/step_record.hpp"
#include "simulation/step/tool_lead.hpp"

namespace irdm::replay {

/// What a step of one object needs of the whole recorded one.
struct RecordedStep {
  std::span<const StylusRecord> styluses;
  std::span<const BodyContactRecord> body_contacts;  ///< of all objects
};

/// One object under the forces that a trace has of it: they deform it and move it. Pure; one
/// thread.
class ForcedBody {
 public:
  virtual ~ForcedBody() = default;

  virtual void reset() = 0;
  /// Before the step: a force that belonged to an earlier one.
  virtual void insert_delayed_force(const LateForce& late) = 0;
  /// From the next step on.
  virtual void set(const Vector3& gravity, const ObjectSettings& settings) = 0;
  /// @param again the recorded step, whose contacts and floor's forces act; the start of the step
  /// and the motion are written, and forces, where they are not kept in B
  /// @param recorded what else is in it: other bodies' forces act, too
  virtual void step(ObjectRecord& again, const RecordedStep& recorded) = 0;
  /// Instead, where the object is asleep: start of the step and motion are written.
  virtual void rest(ObjectRecord& again) = 0;
  /// Of all surface nodes at the end of the last step, (n, 3) [m], B.
  virtual void displacement(Points& u) const = 0;
};

/// By its response: the forces as they stand in B, each with the lever arm of the point that it
/// acts on as the engine has it here; those of other bodies as they stand in W, with their recorded
/// lever arms. Nothing is solved.
class ForcedObject final : public ForcedBody {
 public:
  /// @param config of the scene, for its styluses  @param number of the object in it
  ForcedObject(const SimulationConfig& config, std::size_t number);

  void reset() override;
  void insert_delayed_force(const LateForce& late) override;
  void set(const Vector3& gravity, const ObjectSettings& settings) override;
  void step(ObjectRecord& again, const RecordedStep& recorded) override;
  void rest(ObjectRecord& again) override { body_.rest(again); }
  void displacement(Points& u) const override { body_.engine().displacement(u); }

 private:
  Vector3 place(const ContactPatch& patch) const;
  void lead(std::span<const StylusRecord> styluses);
  RigidStateHistory::Forces collect(const ObjectRecord& recorded);

  int number_;
  DeformableBody body_;
  RestSurface surface_;
  std::vector<PressureMask> masks_;
  RecordedForces forces_;
  ContactPatch patch_;
  std::vector<TouchForce> touch_;  ///< of the step under way
  std::optional<ToolLead> lead_;   ///< it is a tool; by stylus led_by_
  std::size_t led_by_ = 0;
};

}  // namespace irdm::replay
