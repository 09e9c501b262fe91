#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "common/contact/applied_forces.hpp"
#include "common/contact/contact_model.hpp"
#include "common/motion/free_motion.hpp"
#include "common/motion/rigid_body.hpp"
#include "common/motion/rigid_state_history.hpp"
#include "simulation/collision/deformed_surface.hpp"
#include "simulation/contact/pressure_mask.hpp"
#include "simulation/contact/smoothed_surface.hpp"
#include "simulation/engine/response_engine.hpp"
#include "simulation/step/floor_contacts.hpp"
#include "simulation/step/god_object.hpp"
#include "simulation/step/nodal_forces.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// One object and the contacts that styluses have with it: the force step (docs/architecture.md,
/// one force step) of that object. Pure: no clock, thread, file or socket. Real-time safe after
/// construction; one thread. What a step costs does not depend on the size of the object, but for
/// contacts with the floor.
class SoftObject {
 public:
  /// Throws Error when the model lacks the response that its engine or its spin needs, or a
  /// fingertip is too
  /// large for its surface.
  SoftObject(const SimulationObject& object, const SimulationConfig& config, int number);

  /// One step of dt. `commands`: one a stylus.
  void step(std::span<const StylusCommand> commands, ObjectRecord& record) noexcept;
  void reset() noexcept;
  /// From the next step on.
  void set(const Vector3& gravity, const ObjectSettings& settings) noexcept;

  /// What a bridge needs to solve the contact of stylus s by itself in the coming steps. The forces
  /// of the floor are taken to stay as they were in the last step, those of other styluses as they
  /// were on average over the last while: were they taken as they are, two bridges would answer
  /// each other's last answer, and shake a stiff object. Between steps.
  /// @param tip where the stylus was in the last step [m], W
  /// @param horizon steps to look ahead, 1 to kMaxHorizon
  void predict_horizon(std::size_t s, const Vector3& tip, int horizon,
                       ContactModel& model) noexcept;
  /// What stylus s exerted, besides what is known, in the step `age` steps before the last one: at
  /// the contact that it had then, or else where the tip was near the surface. Between steps.
  /// False: neither.
  /// @param entry knows its age; the rest of it is written
  bool insert_delayed_force(std::size_t s, const AppliedForce& applied, LateForce& entry) noexcept;
  /// The same of an entry that is whole. False: that is too long ago.
  bool insert_delayed_force(const LateForce& entry) noexcept;
  /// From the surface to a point of W, positive outside [m]. Between steps.
  double distance(const Vector3& tip) noexcept;
  ContactState contact_state(std::size_t s) const noexcept { return styluses_[s].state(); }

  const Model& model() const noexcept { return *model_; }
  const RigidState& state() const noexcept { return state_; }
  const ResponseEngine& engine() const noexcept { return *engine_; }
  const RestSurface& surface() const noexcept { return rest_; }

 private:
  /// A contact of this step.
  struct Contact {
    int stylus = 0;
    bool given = false;
    bool bridged = false;
    bool lets_go = false;                ///< bridged, and by itself it would be open
    ContactLaw law = ContactLaw::kHeld;  ///< of a bridged one, were it not
    Vector3 arm = Vector3::Zero();       ///< r_a = X_a + h_a [m], B
    Vector3 free = Vector3::Zero();      ///< h_a [m], B
    Vector3 moved = Vector3::Zero();  ///< displacement of the place by the end of the step [m], B
    Vector3 arm_shift = Vector3::Zero();  ///< as ContactRecord::arm_shift
    Vector3 normal = Vector3::Zero();     ///< of a touching one
  };
  /// The last contact of a stylus.
  struct LastContact {
    bool any = false;
    std::uint64_t first_step = 0;  ///< of its steps, counted from the start of this object
    std::uint64_t last_step = 0;
    SurfacePoint point;
    ContactPatch patch;
    Vector3 arm = Vector3::Zero();        ///< of its force [m], B
    Vector3 average = Vector3::Zero();    ///< of its force over the last while [N], B
    Vector3 displaced = Vector3::Zero();  ///< of its place by the end of its step [m], B
  };
  void apply_remote_contact(std::size_t s, const StylusCommand& command) noexcept;
  double displaced() const noexcept;
  Vector3 accepted_arm(const Vector3& arm, const Vector3& own) const noexcept;
  bool place_late(std::size_t s, const Vector3& tip, LateForce& entry) noexcept;
  void collect_others(std::size_t s, ContactModel& model) noexcept;
  void follow_bridged(std::span<const StylusCommand> commands) noexcept;
  void spin(ObjectRecord& record) noexcept;
  void prefetch_columns(std::span<const StylusCommand> commands) noexcept;
  void collect(std::span<const StylusCommand> commands) noexcept;
  bool project_initial_contact(std::size_t s, const Vector3& tip) noexcept;
  void predict_contacts() noexcept;
  void assemble_contacts(std::span<const StylusCommand> commands) noexcept;
  void solve(std::span<const StylusCommand> commands, ObjectRecord& record) noexcept;
  void pose_floor() noexcept;
  void update_contacts(std::span<const StylusCommand> commands) noexcept;
  void cache_nodes() noexcept;
  void advance() noexcept;
  Vector3 arm_shift(int a, const Vector3& moved) const noexcept;
  void write(ObjectRecord& record) noexcept;
  void write_floor(ObjectRecord& record) noexcept;

  std::shared_ptr<const Model> model_;
  SimulationObject object_;
  SimulationConfig config_;
  int number_;
  std::unique_ptr<ResponseEngine> engine_;
  RestSurface rest_;
  DeformedSurface surface_;
  RigidBody body_;
  double material_damping_ = 1.0;
  bool feels_spin_;
  double size_ = 0.0;  ///< largest distance of the surface from the centre of mass [m]
  FreeForces free_forces_;
  std::uint64_t steps_ = 0;  ///< made so far
  RigidState start_;
  RigidState state_;
  RigidStateHistory past_;
  std::vector<GodObject> styluses_;
  std::vector<PressureMask> masks_;
  std::vector<SmoothedSurface> rounded_;  ///< as each stylus feels it
  std::unique_ptr<FloorContacts> floor_;  ///< null: no floor

  // Of the step under way.
  FreeMotion motion_;
  int contact_count_ = 0;  ///< of styluses; in the problem they come after those of the floor
  int floor_count_ = 0;
  std::array<Contact, kMaxContacts> contacts_{};
  std::vector<LastContact> last_;  ///< one a stylus
  ContactPatch local_model_patch_;
  std::array<SurfacePoint, kMaxContacts> points_{};
  std::array<ContactPatch, kMaxContacts> patches_{};
  ContactMatrix elastic_;  ///< elastic compliance between the contacts, (3m, 3m) [m/N], B
  ContactProblem problem_;
  ContactSolver solver_;
  NodalForces nodal_;
};

}  // namespace irdm
