#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/contact/contact_model.hpp"
#include "common/contact/persistent_contact.hpp"
#include "common/motion/free_motion.hpp"
#include "simulation/collision/deformed_surface.hpp"
#include "simulation/contact/pressure_mask.hpp"
#include "simulation/contact/smoothed_surface.hpp"
#include "simulation/engine/response_engine.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/step/assembly_horizon.hpp"
#include "simulation/step/energy_account.hpp"
#include "simulation/step/god_object.hpp"
#include "simulation/step/nodal_forces.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"
#include "simulation/step/work_ledger.hpp"

namespace irdm {

/// The contacts of all styluses with one object, from step to step. One step is find(), predict(),
/// pose(), after the solution solve_bridged(), write(), update(), and end_step(). Components in B
/// where nothing else is said. Real-time safe after construction; one thread.
class StylusContacts {
 public:
  /// Throws Error when a fingertip is too large for the surface.
  /// @param dt of a step [s]  @param object its number in the scene
  /// @param rest, surface of the object; they outlive this
  StylusContacts(const SimulationConfig& config, double dt, int object, const RestSurface& rest,
                 DeformedSurface& surface);

  void reset() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state) {
    for (Stylus& stylus : styluses_) {
      state.value(stylus.proxy);
      state.value(stylus.displacement);
      state.value(stylus.last);
      state.value(stylus.position);
      state.value(stylus.way);
      state.value(stylus.velocity);
      state.value(stylus.ledger);
      stylus.prediction = {};
    }
    state.value(steps_);
    state.value(work_);
    state.value(late_work_);
    state.value(limited_);
    if (state.reading()) count_ = 0;
  }

  /// Decides which styluses are in contact in this step, and where.
  void find(std::span<const StylusCommand> commands, const FreeMotion& motion) noexcept;
  /// Where their places would be without force, and the elastic compliance between them.
  void predict(ResponseEngine& engine) noexcept;
  /// Writes them into the problem, from row `first` on; those of the floor come before.
  /// @param account of the object, which bounds what forces of bridges put in  @param engine its
  void pose(std::span<const StylusCommand> commands, const FreeMotion& motion,
            const Friction& friction, EnergyAccount& account, ResponseEngine& engine, int first,
            ContactProblem& problem) noexcept;
  /// What the contacts of bridges would do by themselves among the others' forces: that is how they
  /// slip and end.
  void solve_bridged(ContactProblem& problem) noexcept;
  /// The contacts as they were solved; proxies in B.
  void write(const ContactProblem& problem, ObjectRecord& record) noexcept;
  /// How they go on into the next step.
  void update(std::span<const StylusCommand> commands, const FreeMotion& motion,
              const ContactProblem& problem) noexcept;
  /// Adds their forces to those of the step, which ends here.
  void end_step(const ContactProblem& problem, const Quaternion& halfway, NodalForces& nodal,
                RigidStateHistory::Forces& forces) noexcept;

  /// Of all tips against the object in the step that has ended [J]: for a bridge's force, which the
  /// device shows after its step, that of the step before.
  double work() const noexcept { return work_; }
  /// As Simulation::tell_late().
  void tell_late(std::size_t s, const Vector3& tip, int age) noexcept;
  /// Of what was told late since the last step, with a force that would be entered now [J].
  /// @param force on the object [N], W
  double unsettled_work(std::size_t s, const Vector3& force, int age) const noexcept;
  /// It was entered.
  void add_delayed(std::size_t s, const Vector3& force, int age) noexcept;
  /// Forces of bridges that acted in part, or not at all, by the object's account, so far.
  std::uint64_t limited() const noexcept { return limited_; }
  /// The part of the force of stylus s's bridge that acted in the last step, 0 to 1.
  double share(std::size_t s) const noexcept { return styluses_[s].share; }

  int count() const noexcept { return count_; }
  const ContactPatch& patch(int a) const noexcept { return patches_[static_cast<std::size_t>(a)]; }
  /// Largest displacement under a stylus by the end of the last step [m].
  double displaced() const noexcept;

  // Between steps, for the bridge of stylus s.
  ContactState state(std::size_t s) const noexcept { return styluses_[s].proxy.state(); }
  /// Returns whether stylus s holds the object, and is not letting go.
  bool holds(std::size_t s) const noexcept {
    return state(s) == ContactState::kHeld && !styluses_[s].proxy.contact().releasing();
  }
  /// Whether a contact goes on, or may begin.
  bool may_touch(std::size_t s) const noexcept;
  /// State, place and normal of its contact, or of where one would begin, which stays for some
  /// steps until end_prediction(); and the patch there.
  /// @param tip in the coming step [m]
  /// @param budget as for Simulation::predict_horizon(), for the point that is nearest to the tip
  bool locate(std::size_t s, const Vector3& tip, ContactModel& model, ContactPatch& patch,
              int& budget) noexcept;
  void end_prediction(std::size_t s, const ContactPatch& patch) noexcept;
  /// The compliance in series with the contact. False: what is left of a hold ends with this step.
  /// @param mobility of the body; the model has place, path and response
  bool write_series(std::size_t s, const RigidMobility& mobility, ContactModel& model) noexcept;
  /// What the other styluses exert: averages, for were they taken as they are, two bridges would
  /// answer each other's last answer, and shake a stiff object.
  /// @param problem of the last step
  void add_others(std::size_t s, const ContactProblem& problem, NodalForces& nodal,
                  ContactModel& model) const noexcept;
  /// The contact of another stylus that answers in the model of this one, if there is any: that
  /// which exerts most on average. What is being released stays with the forces of add_others().
  bool find_other(std::size_t s, const Friction& friction, const ContactProblem& problem,
                  AssemblyHorizon::Contact& found) noexcept;
  /// The force of stylus s on average over the last while [N].
  const Vector3& average(std::size_t s) const noexcept { return styluses_[s].last.average; }
  /// Where a force acted `entry.age` steps before the last one: at the contact of then, or else at
  /// the tip, if that is near the surface. Point and arm are written. False: neither.
  /// @param tip in the coming step [m]  @param arm where the bridge says that it was [m]
  bool locate_delayed(std::size_t s, const Vector3& tip, const Vector3& arm,
                      LateForce& entry) noexcept;
  /// Spreads a force [N] on the object over the nodes under the tip of stylus s.
  void spread(std::size_t s, const SurfacePoint& point, const Vector3& force,
              NodalForces& nodal) noexcept;

 private:
  /// The last contact of a stylus that had a force.
  struct LastContact {
    bool any = false;
    std::uint64_t first_step = 0;  ///< of its steps
    std::uint64_t last_step = 0;
    SurfacePoint point;
    Vector3 arm = Vector3::Zero();      ///< of its force [m]
    Vector3 average = Vector3::Zero();  ///< of its force over the last while [N]
  };
  /// Where a contact model has its contact.
  struct Prediction {
    ContactPatch patch;
    SurfacePoint point;      ///< that the patch of a free tip lies about
    std::uint64_t step = 0;  ///< in which it was there
    bool under_way = false;  ///< of a free tip; it may take several steps to compute a model
  };
  struct Stylus {
    SimulationStylus tip;
    PressureMask mask;
    SmoothedSurface felt;  ///< the surface as it feels it
    GodObject proxy = {};
    ContactDisplacement displacement = {};  ///< of its contact's place
    LastContact last = {};
    std::optional<Vector3> position = {};  ///< of its tip in the last step [m], W; none: not there
    Vector3 way = Vector3::Zero();         ///< of its tip in that step [m], W
    Vector3 velocity = Vector3::Zero();    ///< of its tip, smoothed [m/s], W
    WorkLedger ledger = {};                ///< of its bridge's forces
    double share = 1.0;                    ///< of its bridge's force in this step that acts
    /// Force on the object that its ball exerted before it took hold in this step [N].
    std::optional<Vector3> gripped = {};
    Prediction prediction = {};
  };
  /// A contact of this step.
  struct Contact {
    int stylus = 0;
    bool given = false;
    bool bridged = false;
    bool lets_go = false;                ///< bridged, and by itself it would be open
    ContactLaw law = ContactLaw::kHeld;  ///< of a bridged one, were it not
    SurfacePoint point;
    Vector3 arm = Vector3::Zero();        ///< r_a = X_a + h_a [m]
    Vector3 free = Vector3::Zero();       ///< h_a [m]
    Vector3 moved = Vector3::Zero();      ///< displacement of the place by the end of the step [m]
    Vector3 arm_shift = Vector3::Zero();  ///< as ContactRecord::arm_shift
    Vector3 normal = Vector3::Zero();     ///< of a touching one
  };

  /// Elastic compliance between contacts a and b of this step [m/N].
  auto elastic_between(int a, int b) const noexcept { return elastic_.block<3, 3>(3 * a, 3 * b); }
  Stylus& stylus_of(const Contact& contact) noexcept {
    return styluses_[static_cast<std::size_t>(contact.stylus)];
  }
  std::optional<std::size_t> strongest_other(std::size_t s,
                                             const ContactProblem& problem) const noexcept;
  void begin_prediction(Stylus& stylus, const SurfacePoint& point) noexcept;
  SmoothedSurface::Place place_of(Stylus& stylus, ContactState state,
                                  const SurfacePoint& point) noexcept;
  void follow(Stylus& stylus, const StylusCommand& command) noexcept;
  bool find_contact(Stylus& stylus, const StylusCommand& command, const Vector3& tip) noexcept;
  bool find_grip(Stylus& stylus, const StylusCommand& command, const Vector3& tip) noexcept;
  void apply_remote_contact(Stylus& stylus, const BridgedForce& bridged,
                            const Vector3& tip) noexcept;
  bool project_initial_contact(Stylus& stylus, const Vector3& tip) noexcept;
  void pose_contact(Contact& contact, const StylusCommand& command, const FreeMotion& motion,
                    const Friction& friction, int row, ContactProblem& problem) noexcept;
  /// Counted from 1; 0: before the first step.
  std::uint64_t told_step(int age) const noexcept {
    return steps_ - std::min(steps_, static_cast<std::uint64_t>(age));
  }
  EnergyChange elastic_change(int a, const Vector3& force, ResponseEngine& engine) noexcept;
  void bound_remote_force(const BridgedForce& bridged, const FreeMotion& motion,
                          EnergyAccount& account, ResponseEngine& engine, int row,
                          ContactProblem& problem) noexcept;
  Vector3 accepted_arm(const Vector3& arm, const Vector3& own) const noexcept;

  const RestSurface& rest_;
  DeformedSurface& surface_;
  double dt_;
  double release_time_;
  int object_;
  double size_ = 0.0;  ///< largest distance of the surface from the centre of mass [m]
  std::vector<Stylus> styluses_;
  std::uint64_t steps_ = 0;  ///< made so far
  double work_ = 0.0;
  double late_work_ = 0.0;  ///< of work_, what was settled late before the coming step
  std::uint64_t limited_ = 0;
  bool delayed_ = false;  ///< forces were entered since the last step

  // Of the step under way.
  int count_ = 0;
  int first_ = 0;  ///< row of the first of them in the problem
  std::array<Contact, kMaxContacts> contacts_{};
  std::array<ContactPatch, kMaxContacts> patches_{};  ///< of each contact, in a row for the engine
  ContactMatrix elastic_;  ///< elastic compliance between the contacts, (3m, 3m) [m/N]
};

}  // namespace irdm
