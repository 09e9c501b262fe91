#pragma once

#include "common/motion/free_motion.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// How a stylus leads its tool: where the home of the coupling is in each step, and how much of the
/// coupling's force the stylus gets. The tool's reference point is wanted at the tip, and the tool
/// as the stylus turns it from how it stood at the start.
///
/// While nobody is there the home stays. When a stylus appears, and after a reset, the home comes
/// to it from where it is, no faster than kApproach and kAngularApproach; until it has arrived the
/// stylus gets nothing, and then a share that grows to 1 within kRamp: no force jumps. Pure,
/// real-time safe; one thread.
class ToolLead {
 public:
  static constexpr double kApproach = 0.5;         ///< [m/s]
  static constexpr double kAngularApproach = 5.0;  ///< [rad/s]
  static constexpr double kRamp = 0.1;             ///< [s]

  /// Throws Error, naming `where`, when the coupling is not one for the object (PoseCoupling).
  ToolLead(const ToolCoupling& tool, const SimulationObject& object, const std::string& where);

  /// The home is where the tool is at the start, and nobody is there.
  void reset() noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state) {
    state.value(position_);
    state.value(orientation_);
    state.value(home_);
    state.value(arrived_);
    state.value(share_);
  }
  /// The coming step.
  void begin(const StylusCommand& command) noexcept;
  /// Of that step. The coupling in it is this one's, which must outlive it.
  CouplingStep step() const noexcept { return {&coupling_, home_}; }
  /// The part of the coupling's force and torque that the stylus gets in that step, 0..1.
  double share() const noexcept { return share_; }

  int object() const noexcept { return object_; }
  const PoseCoupling& coupling() const noexcept { return coupling_; }

 private:
  void move_to(const Vector3& position, const Quaternion& orientation) noexcept;

  int object_;
  double dt_;
  PoseCoupling coupling_;
  Vector3 start_position_;        ///< of the reference point [m], W
  Quaternion start_orientation_;  ///< B to W
  Vector3 position_;              ///< of the home at the end of the step [m], W
  Quaternion orientation_;
  CouplingHome home_;
  bool arrived_ = false;
  double share_ = 0.0;
};

}  // namespace irdm
