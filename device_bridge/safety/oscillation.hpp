#pragma once

namespace irdm {

struct OscillationLimits {
  double fresh = 5e-3;   ///< a force that is at most so old in a cycle's mean is let alone [s]
  double swing = 1e-5;   ///< energy that comes and goes without counting as a cycle [J]
  double longest = 0.5;  ///< of a cycle [s]; slower is a hand that moves, or is moved
  double active = 0.2;   ///< share of what it took that it gives beyond it, at least
  double debt = 5e-4;    ///< given by cycles on balance at which the gain is cut [J]
  double cut = 0.5;      ///< what is left of the gain
  double least = 1.0 / 64;
  double recovery = 15.0;  ///< time constant with which it comes back [s]
};

/// Gain of the force, lowered while it shakes the hand. A force that is late gives energy in every
/// cycle of an oscillation, the more the stiffer the object, and bounded damping does not always
/// hold it. Cycles are told by the lows of the energy that the device has taken: where these sink
/// from one to the next by a share of what came and went, soon after each other, the loop is
/// active; half the force is half the stiffness, until it is not. Another hand's push, or a weight
/// that is let down, gives energy without such cycles. A force that is fresh is left to the
/// damping: a bounce from a wall a step or two away gives energy too, and ends. Pure, real-time
/// safe.
class Oscillation {
 public:
  explicit Oscillation(const OscillationLimits& limits) : limits_(limits) {}

  /// @param work that the hand did on the device since the last tick [J]; not finite: none
  /// @param elapsed since then [s]
  /// @param age of the tip that the force answered [s]
  void observe(double work, double elapsed, double age) noexcept;

  /// Share of the force to show, above 0 and at most 1.
  double gain() const noexcept { return gain_; }
  /// Forgets all.
  void reset() noexcept { *this = Oscillation(limits_); }

 private:
  void pass_low() noexcept;
  bool active(double low) const noexcept;
  void cut() noexcept;

  OscillationLimits limits_;
  double energy_ = 0.0;   ///< taken since the last low [J]
  double high_ = 0.0;     ///< its highest [J]
  double extreme_ = 0.0;  ///< the same while it rises, its lowest while it falls [J]
  bool rising_ = false;
  bool cycling_ = false;  ///< the last low came soon after the one before
  double time_ = 0.0;     ///< since the last low [s]
  double ages_ = 0.0;     ///< integral of the age since then [s^2]
  double debt_ = 0.0;     ///< of the cycles before it [J]
  double gain_ = 1.0;
};

}  // namespace irdm
