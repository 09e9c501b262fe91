#pragma once

#include <cstdint>

#include "common/contact/contact_problem.hpp"
#include "common/stylus.hpp"

namespace irdm {

/// A touch begins no deeper below the surface than this, beyond the way of the tip in the step [m]:
/// a tip that is deeper was inside all along, and there is no telling how it got there.
inline constexpr double kDeepestStart = 2e-3;

/// One contact from step to step, wherever it is solved: a stylus' at the server, the same one at
/// its bridge, a node's with the floor. It is free, touching, held or being released, and slips or
/// does not; of that it poses the constraint of the coming step. Real-time safe.
class PersistentContact {
 public:
  void begin(ContactState state, bool slipping = false) noexcept {
    state_ = state;
    slipping_ = slipping;
    release_steps_ = kNotReleased;
  }
  void end() noexcept { begin(ContactState::kFree); }
  /// What is touched is taken hold of, or is held on; what is held so is not released.
  void hold() noexcept { begin(ContactState::kHeld, slipping_); }
  /// What was held is touched from now on.
  void turn_to_touching() noexcept { begin(ContactState::kTouching, slipping_); }
  /// One more step in which what was held is not held any longer: it is given up gradually.
  void release() noexcept { ++release_steps_; }
  void set_slipping(bool slipping) noexcept { slipping_ = slipping; }

  ContactState state() const noexcept { return state_; }
  bool any() const noexcept { return state_ != ContactState::kFree; }
  /// It slipped in the last step.
  bool slipping() const noexcept { return slipping_; }
  /// It is not held any longer, but not given up yet.
  bool releasing() const noexcept { return release_steps_ != kNotReleased; }
  /// What is left of the hold `ahead` steps after this one, from 1 down; 0 or less: nothing.
  /// @param dt of a step [s]  @param time in which a hold is given up [s]
  double hold_left(double dt, double time, int ahead = 0) const noexcept {
    return 1.0 - (release_steps_ + ahead) * dt / time;
  }

  /// What the coming step asks of it: its law, its friction (what slips goes on slipping until
  /// kinetic friction can hold it) and its gap. Everything in the frame of the problem.
  /// @param normal outward, of the surface; means nothing when held
  /// @param arm where its point would be without force [m]  @param target where it is wanted [m]
  void pose(const Vector3& normal, const Friction& friction, const Vector3& arm,
            const Vector3& target, ContactConstraint& constraint) const noexcept {
    constraint.law = state_ == ContactState::kHeld ? ContactLaw::kHeld : ContactLaw::kTouching;
    constraint.normal = normal;
    constraint.friction = friction;
    if (slipping_) constraint.friction.static_ = friction.kinetic;
    constraint.arm = arm;
    constraint.gap = target - arm;
  }

 private:
  static constexpr int kNotReleased = -1;

  ContactState state_ = ContactState::kFree;
  bool slipping_ = false;
  int release_steps_ = kNotReleased;  ///< how many steps ago the hold ended
};

/// The spring in series with a held contact that is given up: softer and softer [m/N].
/// @param left of the hold, 0 < left <= 1  @param within compliance of the contact [m/N]
inline Matrix3 release_compliance(double left, const Matrix3& within) noexcept {
  return (1.0 / left - 1.0) * within;
}

/// How far the place of a contact is displaced, from step to step: the lever arm of a force that is
/// held through a step is the mean one over the step (docs/theory.md). In B. Real-time safe.
class ContactDisplacement {
 public:
  /// Step k has ended with a force, which left the place displaced so [m].
  void remember(std::uint64_t k, const Vector3& displaced) noexcept {
    step_ = k;
    displaced_ = displaced;
  }
  /// The last force was in the step before k.
  bool goes_on_in(std::uint64_t k) const noexcept { return step_ + 1 == k; }
  /// At the end of the last step with a force [m].
  const Vector3& last() const noexcept { return displaced_; }

  /// From where the place would be at the end of step k without force to where it is in the mean
  /// over the step [m].
  /// @param free, moved its displacement at the end of the step without and with forces [m]
  Vector3 arm_shift(std::uint64_t k, const Vector3& free, const Vector3& moved) const noexcept {
    return 0.5 * ((goes_on_in(k) ? displaced_ : free) + moved) - free;
  }

 private:
  std::uint64_t step_ = ~std::uint64_t{0} - 1;  ///< of the last force
  Vector3 displaced_ = Vector3::Zero();
};

}  // namespace irdm
