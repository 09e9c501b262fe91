#pragma once

#include <memory>
#include <vector>

#include "precompute/dynamics/implicit_midpoint.hpp"
#include "precompute/dynamics/rigid_extraction.hpp"
#include "replay/reference/broyden_solver.hpp"
#include "replay/reference/step_journal.hpp"
#include "replay/rerun/forced_object.hpp"
#include "replay/rerun/rerun.hpp"
#include "simulation/step/nodal_forces.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm::replay {

/// How many equal sub-steps, none above `longest` [s], a step of dt [s] is cut into.
int fem_parts(double dt, double longest);

/// By finite elements, without modes, R or rigid body: the whole mesh, of large rotations, stepped
/// by ImplicitMidpoint. Recorded forces act in W on the points of the surface that they were
/// recorded at, constant during a step. What the server does to the rigid motion alone (gravity,
/// damping, tether, the couple of a contact's offset from the nodes that have its force) is a field
/// of accelerations here that moves the mesh as a rigid body, taken in by half kicks before and
/// after each sub-step (Strang: second order, as the rule itself). A sub-step that cannot be solved
/// is made in halves. Large: it shares nothing with the force step that it checks, so mesh, motion,
/// contacts and solver are all here.
class FemBody final : public ForcedBody {
 public:
  /// Throws Error when the object does not float.
  /// @param config of the scene  @param number of the object in it
  /// @param substep longest step of the rule [s], > 0; the server's is cut into equal ones
  /// @param follow_tips points that are held follow their tips as in the server's step, with the
  /// force that this takes here, in place of the recorded one
  /// @param delayed_forces of this object: they act in the steps that they belong to
  FemBody(const SimulationConfig& config, std::size_t number, precompute::Elasticity elasticity,
          double substep, bool follow_tips = false, std::vector<DelayedForces> delayed_forces = {});

  /// From now on: steps that a journal has are taken from it, and others kept in it.
  /// @param journal must outlive this object
  void use(StepJournal& journal) noexcept { journal_ = &journal; }

  void reset() override;
  /// Nothing: it has acted in its own step.
  void insert_delayed_force(const LateForce& /*late*/) override {}
  void set(const Vector3& gravity, const ObjectSettings& settings) override;
  /// Contact forces and the floor's are written as they stand in B here.
  void step(ObjectRecord& again, const RecordedStep& recorded) override;
  /// The mesh stops.
  void rest(ObjectRecord& again) override;
  void displacement(Points& u) const override;

 private:
  /// A couple that acts by no node: offset (B) x force (W).
  struct OffsetForce {
    Vector3 offset, force;
  };
  /// A contact that follows its tip.
  struct Followed {
    std::size_t stylus;
    Vector3 tip;        ///< at the end of the step [m], W
    double compliance;  ///< of the coupling spring [m/N]
    ContactPatch patch;
  };
  /// The body with the material as it is now.
  struct Mesh {
    Mesh(const Model& model, precompute::Elasticity elasticity, double damping, double h);
    precompute::SoftBody body;
    precompute::ImplicitMidpoint rule;
  };

  RigidState rigid_state() const;
  precompute::RigidMotion rigid_motion() const;
  Vector3 angular_velocity(const RigidState& state) const;
  void hold(const ObjectRecord& recorded);
  void add_forces(std::span<const NodalForce> forces, const Quaternion& Q);
  void hold_late();
  void hold_touches(const Quaternion& halfway);
  Vector3 place(int node) const;
  Vector3 place(const ContactPatch& patch) const;
  Vector3 place(const TouchForce& touch) const;
  bool kicks() const;
  void kick(double time);
  void advance(double h, int halvings);
  void move(const ObjectRecord& recorded);
  bool follows(const ContactRecord& contact, const StylusRecord& stylus) const;
  void choose_followed(const ObjectRecord& recorded, std::span<const StylusRecord> styluses);
  Eigen::VectorXd misses(const ObjectRecord& moved) const;
  void follow(ObjectRecord& recorded);
  void put_forces(const Eigen::VectorXd& forces, ObjectRecord& recorded) const;
  void remember_forces(const Eigen::VectorXd& forces);
  void solve(ObjectRecord& recorded);
  bool take_from_journal(ObjectRecord& recorded);
  void keep_in_journal();

  int number_;
  std::shared_ptr<const Model> model_;
  RigidBody rigid_;
  RestSurface surface_;
  RecordedForces recorded_forces_;
  std::unique_ptr<ContactSampling> sampling_;         ///< null: it touches no other body
  std::span<const BodyContactRecord> body_contacts_;  ///< of the step under way
  std::vector<TouchForce> touches_;                   ///< the same on this object
  precompute::Elasticity elasticity_;
  bool follow_tips_;
  std::vector<PressureMask> masks_;
  std::vector<double> spring_compliance_;  ///< of each stylus [m/N]
  std::vector<Followed> followed_;
  BroydenSolver tip_forces_;                  ///< [N], W, of all followed_
  std::vector<Eigen::VectorXd> last_forces_;  ///< of the steps before, the last one first
  std::vector<DelayedForces> delayed_forces_;
  std::size_t steps_ = 0;  ///< made so far
  int parts_;              ///< sub-steps of a step
  double h_;               ///< [s]
  RigidState start_;
  FreeForces free_forces_;
  double material_damping_ = 1.0;
  std::unique_ptr<Mesh> mesh_;
  precompute::BodyState state_;
  precompute::ImplicitMidpoint::Workspace workspace_;
  Eigen::VectorXd force_;  ///< of contacts and floor during the step, (3N) [N], W
  std::vector<OffsetForce> couples_;
  StepJournal* journal_ = nullptr;
  std::vector<double> numbers_;  ///< of the journal
};

}  // namespace irdm::replay
