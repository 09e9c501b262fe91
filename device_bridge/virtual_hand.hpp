#pragma once

#include "common/geometry.hpp"

namespace irdm {

/// A hand that holds the stylus: a mass between a spring with a damper, whose other end moves as
/// the hand wants, and the force of the device.
struct HandParameters {
  double mass = 0.12;        ///< of hand and stylus [kg], > 0
  double damping = 2.0;      ///< [N s/m], >= 0
  double stiffness = 300.0;  ///< [N/m], > 0
};

/// m a = stiffness (target - x) + damping (target' - v) + force, solved in closed form over each
/// step for a constant force and a target that moves evenly: exact and stable for any step.
class VirtualHand {
 public:
  /// At rest at `start` [m], D.
  VirtualHand(const HandParameters& parameters, const Vector3& start);

  /// @param dt [s], >= 0
  /// @param target where the hand wants to be at the end of the step [m], D; it moves there evenly
  /// @param force of the device on the hand, constant over the step [N], D
  void advance(double dt, const Vector3& target, const Vector3& force) noexcept;

  const Vector3& position() const noexcept { return position_; }  ///< [m], D
  const Vector3& velocity() const noexcept { return velocity_; }  ///< [m/s], D

 private:
  HandParameters parameters_;
  Vector3 target_;
  Vector3 position_;
  Vector3 velocity_ = Vector3::Zero();
};

}  // namespace irdm
