#pragma once

#include <algorithm>

namespace irdm {

/// The energy that hands gave one object and have not had back, and that it may give back: their
/// work at the tips less what the energy of its rigid motion grew by (docs/theory.md). A passive
/// object keeps it at zero or above; below it, forces that bridges decided on have put in more than
/// the hands did. Beyond kMost it is forgotten, as if lost to damping. Pure.
class EnergyAccount {
 public:
  static constexpr double kMost = 0.2;     ///< that is remembered [J]
  static constexpr double kLeast = -0.05;  ///< the same, below zero
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
  }

  double balance() const noexcept { return balance_; }  ///< [J]
  /// What of a force that drives the object may act: all down to -kAllowance, nothing from twice
  /// that on.
  double driving_share() const noexcept {
    return std::clamp(2.0 + balance_ / kAllowance, 0.0, 1.0);
  }

 private:
  double balance_ = 0.0;
  double energy_ = 0.0;
};

}  // namespace irdm
