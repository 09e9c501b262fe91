#pragma once

#include <cstdint>

namespace irdm {

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
  kFadeDamping,    ///< a force that fades damps
  kRiseLimit,      ///< of the force per time, away from zero
  kFallLimit,      ///< the same, towards zero
  kForceLimit,     ///< largest force; what is not finite becomes zero
  kThermal,        ///< a warm motor is not overheated
};
inline constexpr std::uint32_t kGuardCount = 18;

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
