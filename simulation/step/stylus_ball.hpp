#pragma once

#include "common/geometry.hpp"
#include "simulation/collision/scenery.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// The rigid ball at the tip of a stylus. A spring without mass ties its centre c to the position x
/// of the stylus: c = x - f / k_vc, where f is the sum of the forces that the ball exerts. The
/// contacts of a step use x, with the compliance 1 / k_vc between all of them, and take their
/// geometry from the ball at x - f / k_vc with f of the last step (docs/theory.md, "The ball of a
/// stylus"). Real-time safe; for one thread.
class StylusBall {
 public:
  /// @param radius [m], > 0
  /// @param stiffness k_vc [N/m]; 0: the ball is rigidly at the position of the stylus
  StylusBall(double radius, double stiffness);

  void reset() noexcept;
  /// Saves or restores the state (StateArchive). Not real-time safe.
  void archive(StateArchive& state);

  /// Moves the ball for a step. Returns false if it was present before and is absent now, or was
  /// absent before: its contacts of the last step have ended.
  bool begin(const StylusCommand& command) noexcept;
  /// Ends the step.
  /// @param force sum of the forces that the ball exerted in the step [N], W
  /// @param object the one with the largest force; -1 if there was none
  /// @param solved false if the contact problem had no solution, so that no force acted; the next
  /// step then takes its geometry from the same force as this one
  void end(const Vector3& force, int object, bool solved) noexcept;

  /// The ball as contacts see it.
  const SceneryStep& body() const noexcept { return body_; }
  double compliance() const noexcept { return compliance_; }  ///< of the spring [m/N]
  const Vector3& force() const noexcept { return force_; }    ///< of the last step [N], W
  int object() const noexcept { return object_; }             ///< of the last step, as in end()
  /// Returns the centre c at the end of the last step [m], W.
  const Vector3& centre() const noexcept { return centre_; }

 private:
  SceneryStep body_;
  double compliance_;
  Vector3 tip_ = Vector3::Zero();        ///< position of the stylus in this step [m], W
  Vector3 centre_ = Vector3::Zero();     ///< at the end of the last step [m], W
  Vector3 reference_ = Vector3::Zero();  ///< force from which the next step takes its geometry
  Vector3 force_ = Vector3::Zero();
  int object_ = -1;
};

}  // namespace irdm
