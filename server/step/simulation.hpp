#pragma once

#include <memory>
#include <span>

#include "common/contact/contact_problem.hpp"
#include "common/model/model.hpp"
#include "server/collision/deformed_surface.hpp"
#include "server/engine/response_engine.hpp"
#include "server/motion/rigid_body.hpp"
#include "server/step/step_record.hpp"

namespace irdm {

/// One object among its styluses.
struct SimulationConfig {
  Vector3 gravity = Vector3::Zero();                ///< [m/s^2], W
  Vector3 position = Vector3::Zero();               ///< of the centre of mass at the start [m], W
  Quaternion orientation = Quaternion::Identity();  ///< at the start, B to W
  Vector3 velocity = Vector3::Zero();               ///< at the start [m/s], W
  Vector3 angular_velocity = Vector3::Zero();       ///< at the start [rad/s], W
  double coupling_stiffness = 0.0;  ///< k_vc, spring between tip and surface [N/m]; 0: none (rigid)
  int stylus_count = 1;             ///< 1..kMaxStyluses
};

/// The force step (docs/architecture.md, one force step): a pure function of the commands and of
/// the state in here. It knows no clock, thread, file or socket; the same commands give the same
/// bits. One thread; step() is real-time safe and its cost does not depend on the size of the
/// object.
class Simulation {
 public:
  /// Throws Error when the model lacks the response that its engine needs.
  Simulation(std::shared_ptr<const Model> model, const SimulationConfig& config);

  /// Step k = 0, 1, ...: from time k dt to (k + 1) dt. `commands` has stylus_count entries.
  void step(std::span<const StylusCommand> commands, StepRecord& record) noexcept;

  /// Puts everything back to the start; the step number goes on.
  void reset() noexcept;

  double dt() const noexcept { return model_->dt; }
  const Model& model() const noexcept { return *model_; }
  const RigidState& body_state() const noexcept { return state_; }
  const ResponseEngine& engine() const noexcept { return *engine_; }

 private:
  /// What a stylus carries from step to step.
  struct Stylus {
    ContactState contact = ContactState::kFree;
    int triangle = 0;
    SurfacePoint point;
    Vector3 offset = Vector3::Zero();  ///< [m], B
    /// The tip was outside the surface when last seen near it. Only from there can it make a
    /// contact.
    bool outside = false;
    Vector3 last_tip = Vector3::Zero();  ///< free tip relative to the free motion [m], B
  };
  /// A contact of this step, before or after it is solved.
  struct Contact {
    int stylus = 0;
    ContactState state = ContactState::kFree;
    Vector3 arm = Vector3::Zero();    ///< r_a = X_a + h_a [m], B
    Vector3 force = Vector3::Zero();  ///< on the object [N], B
    bool given = false;
  };
  /// Where everything but the styluses takes the body frame by the end of the step.
  struct FreeMotion {
    Vector3 position = Vector3::Zero();               ///< c + dt v_free [m], W
    Quaternion orientation = Quaternion::Identity();  ///< exp(dt w_free) Q
    /// A point of W in that frame.
    Vector3 to_body(const Vector3& x) const noexcept {
      return orientation.conjugate() * (x - position);
    }
  };

  FreeMotion predict_free_motion() const noexcept;
  void find_contact(const FreeMotion& motion, const StylusCommand& command,
                    Stylus& stylus) noexcept;
  void collect(const FreeMotion& motion, std::span<const StylusCommand> commands) noexcept;
  void predict_contacts() noexcept;
  ContactProblem contact_problem(const FreeMotion& motion, std::span<const StylusCommand> commands,
                                 std::array<std::size_t, kMaxContacts>& unknown) noexcept;
  void solve(const FreeMotion& motion, std::span<const StylusCommand> commands,
             StepRecord& record) noexcept;
  void settle() noexcept;
  void advance() noexcept;
  void write(std::span<const StylusCommand> commands, const Quaternion& orientation,
             StepRecord& record) const noexcept;

  std::shared_ptr<const Model> model_;
  SimulationConfig config_;
  std::unique_ptr<ResponseEngine> engine_;
  DeformedSurface surface_;
  RigidBody body_;
  RigidState start_;
  RigidState state_;
  std::uint64_t next_step_ = 0;
  std::array<Stylus, kMaxStyluses> styluses_{};

  // Of the step under way.
  int contact_count_ = 0;
  std::array<Contact, kMaxContacts> contacts_{};
  std::array<SurfacePoint, kMaxContacts> points_{};
  ContactMatrix elastic_;  ///< elastic compliance between the contacts, (3m, 3m) [m/N], B
  ContactMatrix total_;    ///< the same with the rigid motion's share
};

}  // namespace irdm
