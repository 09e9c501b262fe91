#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "common/contact/applied_forces.hpp"
#include "common/contact/contact_model.hpp"
#include "simulation/collision/deformed_surface.hpp"
#include "simulation/contact/patch_compliance.hpp"
#include "simulation/step/assembly_horizon.hpp"
#include "simulation/step/deformable_body.hpp"
#include "simulation/step/energy_account.hpp"
#include "simulation/step/floor_contacts.hpp"
#include "simulation/step/nodal_forces.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"
#include "simulation/step/stylus_contacts.hpp"

namespace irdm {

/// One object and the contacts that styluses and the floor have with it: the force step
/// (docs/architecture.md) of that object. Pure: no clock, thread, file or socket. Real-time safe
/// after construction; one thread. What a step costs does not depend on the size of the object, but
/// for contacts with the floor.
class SoftObject {
 public:
  /// Throws Error when the model lacks the response that its engine or its spin needs, or a
  /// fingertip is too large for its surface.
  SoftObject(const SimulationObject& object, const SimulationConfig& config, int number);

  // One step of dt is begin(), a solution, write(), perhaps touch(), and finish().

  /// What leads the object in the coming step, and between steps after it.
  void lead(const CouplingStep& led) noexcept { body_.lead(led); }
  /// Free motion, and the contacts with styluses and floor. @param commands one a stylus
  void begin(std::span<const StylusCommand> commands, ObjectRecord& record) noexcept;
  /// The solution of the object's own contacts, where it touches no other body ...
  void solve(ObjectRecord& record) noexcept;
  /// ... or else problem() holds one that was found together with others, and this was its error.
  void accept(const ContactSolution& solution, ObjectRecord& record) noexcept;
  /// The forces of styluses and floor, as they act.
  void write(ObjectRecord& record) noexcept;
  /// Where the centre of mass is half-way through the step under these and `more` [N], W, in which
  /// a force at a point of W has the moment that it has over the step [m], W. After write().
  Vector3 halfway_position(const Vector3& more) const noexcept;
  /// Another body's force acts besides. After write().
  /// @param first whether the sample of the contact is this object's
  /// @param arm from halfway_position() to where it acts [m], W
  void touch(const BodyContactRecord& contact, bool first, const Vector3& arm) noexcept;
  void finish(std::span<const StylusCommand> commands, ObjectRecord& record) noexcept;

  /// Between steps: its steps are left out (Sleep) until wake().
  /// @param record of the last step that was made; becomes that of those that are left out
  void fall_asleep(ObjectRecord& record) noexcept;
  /// Instead of a step that is left out: it stands still, and the styluses are where none of them
  /// touches it. @param record the same
  void rest(std::span<const StylusCommand> commands, ObjectRecord& record) noexcept;
  void wake() noexcept { asleep_ = false; }
  bool asleep() const noexcept { return asleep_; }

  /// Of the contacts with styluses and floor in the step under way, B.
  ContactProblem& problem() noexcept { return problem_; }
  const FreeMotion& motion() const noexcept { return body_.motion(); }
  const RigidBody& rigid() const noexcept { return body_.rigid(); }
  DeformedSurface& deformed_surface() noexcept { return surface_; }
  const Friction& friction() const noexcept { return friction_; }
  /// It can touch other objects and scenery from now on. Before the first step.
  /// @param sampling, compliance of its model; both must outlive this
  void set_contact_shape(const ContactSampling& sampling, const PatchCompliance& compliance);
  const PatchCompliance& contact_compliance() const noexcept { return *compliance_; }
  /// Elastic displacement of the point of contact `row` of problem() per force at a place of the
  /// surface [m/N], B.
  Matrix3 compliance_at(int row, const PatchCompliance::Place& from) const noexcept;
  void reset() noexcept;
  /// State, in or out (StateArchive); between steps.
  void archive(StateArchive& state);
  /// From the next step on.
  void set(const Vector3& gravity, const ObjectSettings& settings) noexcept;

  /// What a bridge needs to solve the contact of stylus s by itself in the coming steps. The forces
  /// of the floor and of other bodies are taken to stay as they were in the last step, those of
  /// other styluses as they were on average over the last while, but for the strongest, which
  /// answers (AssemblyHorizon). Between steps.
  /// @param tip where the stylus was in the last step [m], W
  /// @param horizon steps to predict, 1 to kMaxHorizon
  /// @param budget of predictions that take long: made anew, or with another contact in them;
  /// 1 is taken by one. False: there was none left, and the model means nothing
  bool predict_horizon(std::size_t s, const Vector3& tip, int horizon, ContactModel& model,
                       int& budget) noexcept;
  /// What stylus s exerted, besides what is known, in the step `age` steps before the last one: at
  /// the contact that it had then, or else where the tip was near the surface. Between steps.
  /// False: neither.
  /// @param entry knows its age; the rest of it is written
  bool insert_delayed_force(std::size_t s, const AppliedForce& applied, LateForce& entry) noexcept;
  /// The same of an entry that is whole. False: that is too long ago.
  bool insert_delayed_force(const LateForce& entry) noexcept;
  /// As Simulation::tell_late().
  void tell_late(std::size_t s, const Vector3& tip, int age) noexcept {
    contacts_.tell_late(s, tip, age);
  }
  /// From the surface to a point of W, positive outside [m]. Between steps.
  double distance(const Vector3& tip) noexcept;
  ContactState contact_state(std::size_t s) const noexcept { return contacts_.state(s); }
  bool held_by(std::size_t s) const noexcept { return contacts_.holds(s); }
  /// In the last step.
  bool touched_by_stylus() const noexcept { return contacts_.count() > 0; }

  /// Forces of bridges that EnergyAccount has let act in part or not at all, so far.
  std::uint64_t limited() const noexcept { return contacts_.limited() + limited_late_; }
  /// StylusContacts::share()
  double bridged_share(std::size_t s) const noexcept { return contacts_.share(s); }

  /// Kinetic and elastic, with the potentials of gravity (0 at the origin; of a fixed body 0 where
  /// it is not bent) and tether, at the end of the last step [J]. NaN where the engine does not
  /// know its part (ResponseEngine::energy()). Real-time safe.
  double energy() const noexcept { return body_.energy() + body_.engine().energy(); }

  const Model& model() const noexcept { return body_.model(); }
  const RigidState& state() const noexcept { return body_.state(); }
  /// Of what led it on the object in the last step, at its reference point, W.
  const Wrench& coupling() const noexcept { return body_.coupling(); }
  const ResponseEngine& engine() const noexcept { return body_.engine(); }
  /// Nodes that forces began to act on while their columns of R were not there, so far.
  std::uint64_t cache_misses() const noexcept {
    const ColumnStreaming* const columns = body_.capabilities().columns;
    return columns == nullptr ? 0 : columns->cache_misses();
  }
  const RestSurface& surface() const noexcept { return rest_; }

 private:
  void prefetch_columns(std::span<const StylusCommand> commands) noexcept;
  int find_contacts(std::span<const StylusCommand> commands) noexcept;
  void pose(std::span<const StylusCommand> commands, int floor_count,
            ObjectRecord& record) noexcept;
  void pose_floor() noexcept;
  void write_floor(ObjectRecord& record) noexcept;
  void end_step(ObjectRecord& record) noexcept;
  void cache_nodes() noexcept;
  double work_of_touch(const RigidState& before) const noexcept;
  double share_of_late(const Vector3& force, const LateForce& entry) noexcept;
  double total_energy() noexcept;
  double available_energy(const ContactModel& model) const noexcept;
  bool prepare_horizon(const ContactPatch& patch, bool among_others, ContactModel& model,
                       int& budget) noexcept;
  void collect_others(std::size_t s, ContactModel& model) noexcept;
  void update_surface(bool loaded) noexcept;

  DeformableBody body_;
  RestSurface rest_;
  DeformedSurface surface_;
  /// What has changed the response since update_surface().
  enum class Change { kNone, kStep, kUnknown };
  Change change_ = Change::kUnknown;
  Friction friction_;  ///< of tips on its surface
  StylusContacts contacts_;
  std::unique_ptr<FloorContacts> floor_;  ///< null: no floor
  ContactProblem problem_;                ///< of the step; the floor's contacts come first
  ContactSolver solver_;
  NodalForces nodal_;
  const ContactSampling* sampling_ = nullptr;  ///< null: it touches no other body
  const PatchCompliance* compliance_ = nullptr;
  NodalSums touched_;                     ///< other bodies' forces in the step [N], B
  RigidStateHistory::Forces touched_as_;  ///< the same on the body as a whole
  RigidStateHistory::Forces own_;         ///< of styluses and floor in the step
  EnergyAccount account_;
  double elastic_ = 0.0;            ///< of the last total_energy() [J]
  RigidStateHistory::Forces late_;  ///< that were entered since the last step
  bool asleep_ = false;
  std::uint64_t limited_late_ = 0;
  AssemblyHorizon assembly_;
  AssemblyHorizon::Contact other_;  ///< that answers in a contact model
};

}  // namespace irdm
