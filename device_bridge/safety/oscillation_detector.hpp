#pragma once

namespace irdm {

struct OscillationLimits {
  struct Cycles {
    double longest = 0.0;  ///< of a cycle [s]; slower is a hand that moves, or is moved
    double debt = 0.0;     ///< given by cycles on balance at which the gain is cut [J]
  };
  double fresh_age = 5e-3;   ///< a force is late that is older in a cycle's mean [s]
  Cycles late{0.5, 5e-4};    ///< of a force that is
  Cycles fresh{0.06, 4e-3};  ///< of one that is not, but answers a tip of before
  double owed = 4e-3;        ///< given on balance, in whatever course, at which the gain is cut [J]
  double most = 0.2;         ///< energy that is remembered as taken for that, at most [J]
  double swing = 1e-5;       ///< energy that comes and goes without counting as a cycle [J]
  double active = 0.2;       ///< share of what it took that it gives beyond it, at least
  double cut = 0.5;          ///< what is left of the gain
  double least = 1.0 / 64;
  double recovery = 15.0;  ///< time constant with which it comes back [s]
};

/// Gain of the force, lowered while it shakes the hand. A force that is late gives energy in every
/// cycle of an oscillation, the more the stiffer the object, and bounded damping does not always
/// hold it. Cycles are told by the lows of the energy that the device has taken: where these sink
/// from one to the next by a share of what came and went, soon after each other, the loop is
/// active; so it is where the hand bounces, and each time gets energy until it has lost touch; half
/// the force is half the stiffness, until it is not. A force that is fresh is left to the damping
/// for longer, and in slow cycles: a bounce from a wall a step or two away gives energy too, and
/// ends, and an object that swings gives what it took. Cycles aside, what a late force gives on
/// balance lowers the gain, too, unless the world gave it: another hand's push, or a weight that is
/// let down. A force without any age is never lowered. Pure, real-time safe.
class OscillationDetector {
 public:
  explicit OscillationDetector(const OscillationLimits& limits) : limits_(limits) {}

  /// @param work that the hand did on the device since the last tick [J]; not finite: none
  /// @param elapsed since then [s]
  /// @param age of the tip that the force answered [s]
  /// @param pushed there was a force
  void observe(double work, double elapsed, double age, bool pushed) noexcept;

  /// The world gave this of its own, by another hand or a weight, and the device may [J], >= 0.
  void grant(double energy) noexcept;

  /// Share of the force to show, above 0 and at most 1.
  double gain() const noexcept { return gain_; }
  /// Forgets all.
  void reset() noexcept { *this = OscillationDetector(limits_); }

 private:
  void pass_low() noexcept;
  bool turns(bool pushed) const noexcept;
  OscillationLimits::Cycles limits() const noexcept;
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
  double balance_ = 0.0;  ///< taken and granted less given, since the gain was cut for it [J]
  double gain_ = 1.0;
};

}  // namespace irdm
