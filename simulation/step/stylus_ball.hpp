#pragma once

#include "common/geometry.hpp"
#include "simulation/collision/scenery.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// The rigid ball at the tip of a stylus. A spring without mass ties its centre c to the position x
/// of the stylus: c = x - f / k_vc, where f is the sum of the forces that the ball exerts. The
/// contacts of a step use x, with the compliance 1 / k_vc between all of them, and take their
/// geometry from the ball at x - f / k_vc with f of the last step. The force of its hold on an
/// object, which is a contact of that object, enters both as in the last step (docs/theory.md, "The
/// ball of a stylus"). Real-time safe; for one thread.
class StylusBall {
 public:
  /// @param radius [m], > 0
  /// @param stiffness k_vc [N/m]; 0: the ball is rigidly at the position of the stylus
  StylusBall(double radius, double stiffness);

  void reset() noexcept;
  /// Saves or restores the state (StateArchive). Not real-time safe.
  void archive(StateArchive& state);

  /// Moves the ball for a step. Returns false if the stylus appears or vanishes in this step: the
  /// contacts of the last step have then ended.
  bool begin(const StylusCommand& command) noexcept;

  /// Forces on one object.
  struct Touch {
    int object = -1;                   ///< -1: none
    Vector3 force = Vector3::Zero();   ///< on the object [N], W
    Vector3 middle = Vector3::Zero();  ///< mean place of its contacts, at rest [m], B
  };
  /// Ends the step.
  /// @param force sum of the forces of its contacts in the step, without a hold [N], W
  /// @param held force of its hold on an object [N], W
  /// @param strongest the part on the object with the largest force
  /// @param solved false if the contact problem had no solution, so that no force acted; the next
  /// step then takes its geometry from the same force as this one
  void end(const Vector3& force, const Vector3& held, const Touch& strongest, bool solved) noexcept;

  /// The ball as contacts see it.
  const SceneryStep& body() const noexcept { return body_; }
  double compliance() const noexcept { return compliance_; }  ///< of the spring [m/N]
  /// Forces of its contacts in the last step, without a hold: on all objects [N], W, and on the one
  /// with the largest force.
  const Vector3& force() const noexcept { return force_; }
  const Touch& strongest() const noexcept { return strongest_; }

 private:
  SceneryStep body_;
  double compliance_;
  Vector3 tip_ = Vector3::Zero();        ///< position of the stylus in this step [m], W
  Vector3 centre_ = Vector3::Zero();     ///< at the end of the last step [m], W
  Vector3 reference_ = Vector3::Zero();  ///< force from which the next step takes its geometry
  Vector3 held_ = Vector3::Zero();       ///< force of its hold in the last step [N], W
  Vector3 force_ = Vector3::Zero();
  Touch strongest_;
};

}  // namespace irdm
