#pragma once

#include <algorithm>
#include <cmath>

namespace irdm {

/// The energy that hands gave one object and that is not in it: their work at the tips less what
/// its own energy grew by, that of the rigid motion and, where it is known, of the elastic one
/// (docs/theory.md). A passive object keeps it at zero or above; below it, forces that bridges
/// decided on have put in more than the hands did. Beyond kMost it is forgotten, as if lost to
/// damping, and below zero it is forgiven, slowly while a hand touches. Pure.
class EnergyAccount {
 public:
  static constexpr double kMost = 1.0;               ///< that is remembered [J]
  static constexpr double kLeast = -0.05;            ///< the same, below zero
  static constexpr double kForgiven = 0.005;         ///< below zero, while no hand touches [W] ...
  static constexpr double kForgivenInTouch = 0.002;  ///< ... and while one does
  /// By this much it may be below zero [J]: what rounding, steps and late news make of a passive
  /// object's. As much again below that, no bridge's force puts in any more.
  static constexpr double kAllowance = 0.005;

  /// Begins at a balance of 0. @param energy of the rigid motion and its potential [J]
  void begin(double energy) noexcept {
    balance_ = 0.0;
    energy_ = energy;
  }
  /// What the body's energy is now by another rule, without a motion.
  void set_energy(double energy) noexcept { energy_ = energy; }
  /// At the end of a step. @param work of all hands in it [J]  @param energy at its end [J]
  void settle(double work, double energy) noexcept {
    balance_ = std::clamp(balance_ + work - (energy - energy_), kLeast, kMost);
    energy_ = energy;
    entered_ = 0.0;
  }

  /// Before a step, for a force of an earlier one, which is entered late: its share s that acts, so
  /// that s along + s^2 own, which it adds to the energy, is not above what the balance leaves.
  /// @param along by the motion that there is [J]
  /// @param own by the motion that it makes itself [J], >= 0
  /// @param work of its hand that is not settled yet [J]
  double enter(double along, double own, double work) noexcept {
    return take(along, own, balance_ + kAllowance + std::max(0.0, work));
  }
  /// The same for a force of the coming step.
  /// @param work of all hands in it as far as it is known, not settled yet [J]
  double drive(double along, double own, double work) noexcept {
    return take(along, own, balance_ + 2.0 * kAllowance + work);
  }

  /// After settle(). @param dt of the step [s]  @param touched by a hand in it
  void forgive(double dt, bool touched) noexcept {
    const double rate = touched ? kForgivenInTouch : kForgiven;
    if (balance_ < 0.0) balance_ = std::min(0.0, balance_ + rate * dt);
  }

  double energy() const noexcept { return energy_; }    ///< at the end of the last step [J]
  double balance() const noexcept { return balance_; }  ///< [J]
  /// What of a force that drives the object may act: all down to -kAllowance, nothing from twice
  /// that on.
  double driving_share() const noexcept {
    return std::clamp(2.0 + balance_ / kAllowance, 0.0, 1.0);
  }

 private:
  double take(double along, double own, double most) noexcept {
    const double left = std::max(0.0, most - entered_);
    double share = along > 0.0 ? driving_share() : 1.0;
    if (share * (along + share * own) > left) {
      const double root = std::sqrt(along * along + 4.0 * own * left);
      share =
          std::min(share, along > 0.0 ? 2.0 * left / (along + root) : (root - along) / (2.0 * own));
    }
    entered_ += share * (along + share * own);
    return share;
  }

  double balance_ = 0.0;
  double energy_ = 0.0;
  double entered_ = 0.0;  ///< by forces of bridges, since the last step [J]
};

}  // namespace irdm
