#pragma once

#include <cstdint>

#include "common/geometry.hpp"

namespace irdm {

/// What relates torques to forces and turns to ways: how far from its tip a stylus is held [m]. A
/// turn counts like the way that the hand makes in it, a torque like its force in that hand.
inline constexpr double kLever = 0.05;

/// Of a force; those of a torque are in N m/s.
struct RateLimits {
  double rise = 300.0;      ///< of a force that does not become smaller [N/s]
  double fall = 1200.0;     ///< towards zero [N/s]
  double longest = 2.0e-3;  ///< what is more between two ticks does not count [s]
};

/// How far towards `to` a force may go from `from` [N]; likewise a torque [N m]. One that becomes
/// half as large or less goes straight at the falling rate as long as that takes it nearer to zero;
/// one that does not become smaller goes at the rising rate, and so does what is left of a way; in
/// between the rates blend. So the magnitude never rises faster than `rise`, and nothing changes
/// faster than `fall`; and a wrong force that is larger than the one shown moves it by no more than
/// `rise`, whatever its direction. Pure.
/// @param elapsed since `from` was first shown [s]
Vector3 limit_rate(const Vector3& from, const Vector3& to, const RateLimits& limits,
                   double elapsed) noexcept;

/// Of a force; those of a torque are in N m and N m/s.
struct ThermalLimits {
  double peak = 3.3;            ///< force while the motors are cold [N], > 0
  double continuous = 0.88;     ///< force that they bear for ever [N], > 0
  double time_constant = 60.0;  ///< of their warming up [s]
  double begin = 0.7;           ///< warmth from which on the peak is lowered, 0 to 1
  double slew = 20.0;           ///< of the lowered peak, either way [N/s]
};

/// Warmth of the motors, 0 cold to 1 as warm as the continuous force makes them for ever, followed
/// as a first-order lag of the square of the force; and the largest force that it leaves: the peak
/// up to `begin`, from there down to the continuous force at 1, where the warmth stays. What the
/// device itself says of its warmth counts where it is more. Pure, real-time safe.
class ThermalDerating {
 public:
  explicit ThermalDerating(const ThermalLimits& limits) : limits_(limits), limit_(limits.peak) {}

  /// @param force shown [N], its magnitude
  /// @param elapsed for so long [s]
  /// @param reported warmth by the device, 0 to 1; 0 where it says nothing. Anything.
  void heat(double force, double elapsed, double reported) noexcept;

  double limit() const noexcept { return limit_; }    ///< as peak
  double warmth() const noexcept { return warmth_; }  ///< by our own account

 private:
  ThermalLimits limits_;
  double warmth_ = 0.0;
  double limit_;
};

/// What the safety filter watches over, in the order of a tick.
enum class Guard : std::uint32_t {
  kReadingFinite,  ///< a reading that is not finite or out of reach is not used; several: fault
  kReadingJump,    ///< a reading that no hand can have reached drops the force
  kClock,          ///< time that goes back is a fault, a long gap drops the force
  kSpeed,          ///< a hand faster than the limit for several ticks drops the force
  kFrameFinite,    ///< a demand that is not finite is not used
  kFrameOrder,     ///< nor is one that is older than the newest, or of the future
  kAge,            ///< what is older than its horizon fades
  kLink,           ///< so does what comes from a lost link, at once
  kArming,         ///< no force unless armed
  kRamp,           ///< a force that comes back rises slowly
  kLatch,          ///< a fault stays
  kPushOnly,       ///< a touching contact does not pull
  kPassivity,      ///< energy that the device would give out of nowhere is damped away
  kOscillation,    ///< a force that shakes the hand becomes smaller
  kFadeDamping,    ///< a force that fades damps
  kRiseLimit,      ///< of the force per time, away from zero
  kFallLimit,      ///< the same, towards zero
  kForceLimit,     ///< largest force and torque; what is not finite becomes zero
  kThermal,        ///< a warm motor is not overheated
};
inline constexpr std::uint32_t kGuardCount = 19;

/// Which guards are on: all of them. Only tests take one off, to see that it is missed.
class Guards {
 public:
  bool on(Guard guard) const noexcept {
    return (off_ >> static_cast<std::uint32_t>(guard) & 1) == 0;
  }
  [[nodiscard]] Guards without(Guard guard) const noexcept {
    Guards rest = *this;
    rest.off_ |= 1u << static_cast<std::uint32_t>(guard);
    return rest;
  }

 private:
  std::uint32_t off_ = 0;
};

}  // namespace irdm
