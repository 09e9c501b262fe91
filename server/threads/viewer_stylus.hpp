#pragma once

#include "simulation/step/step_record.hpp"

namespace irdm {

/// Turns what a pointing device says some 60 times a second into a stylus that the force step can
/// follow: smooth, never faster than a hand, and pressing no harder than allowed, as no hand gives
/// way here. Pure; real-time safe.
class ViewerStylus {
 public:
  static constexpr double kSmoothing = 0.015;  ///< time constant [s]
  static constexpr double kFastest = 1.0;      ///< [m/s]

  /// @param stiffness of the spring between tip and surface [N/m]; 0: none, and then no bound
  /// @param max_force that it pushes or pulls with at most [N]; 0: no bound
  ViewerStylus(double dt, double stiffness, double max_force) noexcept
      : dt_(dt), stiffness_(stiffness), max_force_(max_force) {}

  /// The stylus of the coming step.
  /// @param wanted where it is to be
  /// @param last what became of it in the last step
  StylusCommand next(const StylusCommand& wanted, const StylusRecord& last) noexcept;

 private:
  double dt_;
  double stiffness_;
  double max_force_;
  bool present_ = false;
  Vector3 tip_ = Vector3::Zero();
};

}  // namespace irdm
