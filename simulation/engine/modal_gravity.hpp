#pragma once

#include "common/model/model.hpp"
#include "simulation/contact/contact_patch.hpp"
#include "simulation/engine/kernels.hpp"

namespace irdm {

class StateArchive;

/// What gravity does to the modes of a fixed body: a force on each that stays, and what modes that
/// are left out add without delay. Real-time safe after construction; one thread.
class ModalGravity {
 public:
  /// @param response must outlive this object; without gravity: nothing is ever added
  explicit ModalGravity(const ModalResponse& response);

  bool any() const noexcept { return response_.gravity.rows() > 0; }
  /// From the coming step on [m/s^2], B. False: it is what it was.
  bool set(const Vector3& gravity) noexcept;
  /// Whether a force acts on the modes.
  bool acts() const noexcept { return !coming_.isZero(0.0); }
  /// On each mode, (r); where it acts() [kg^1/2 m/s^2].
  const AlignedNumbers& force() const noexcept { return force_; }
  /// Where each mode is at rest under it, (r) [kg^1/2 m].
  void settle(AlignedNumbers& coordinate) const noexcept;
  /// The step ends; or there was one with what acts in the coming one.
  void end_step() noexcept { last_ = coming_; }

  // Of modes that are left out:
  bool adds_rest() const noexcept { return response_.gravity_rest.rows() > 0 && acts(); }
  /// Displacement of a node at the end of a coming step [m].
  Vector3 rest(int node) const noexcept {
    return response_.gravity_rest.middleRows<3>(3 * node) * coming_;
  }
  /// What no component of any node's is larger than in magnitude [m].
  double rest_bound() const noexcept { return largest_rest_.dot(coming_.cwiseAbs()); }
  /// Adds the displacement of all nodes at the end of the last step, (n, 3) [m].
  void add_rest(Points& u) const noexcept;
  /// State, in or out (StateArchive).
  void archive(StateArchive& state);

 private:
  const ModalResponse& response_;
  AlignedNumbers force_;
  Vector3 largest_rest_ = Vector3::Zero();
  Vector3 last_ = Vector3::Zero();    ///< in the last step [m/s^2]
  Vector3 coming_ = Vector3::Zero();  ///< from the coming step on
};

}  // namespace irdm
