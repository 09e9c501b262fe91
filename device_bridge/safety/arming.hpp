#pragma once

#include <cstdint>

#include "device_bridge/safety/guards.hpp"

namespace irdm {

enum class FilterState : std::uint8_t {
  kDisarmed,  ///< no force
  kArmed,     ///< no force yet: waits for one that is fresh
  kEngaged,   ///< shows the force, or a rising share of it
  kFading,    ///< the newest force is too old, or the link is lost: a falling share
  kFault,     ///< no force until disarmed and armed again
};

struct ArmingLimits {
  std::int64_t ramp_ns = 500'000'000;   ///< in which a force comes back without arm action
  std::int64_t pause_ns = 100'000'000;  ///< none at all for so long after a trip
  double small_force = 0.3;             ///< with it, at once below this demand [N]
};

/// States of the filter, and the share of the force that is shown in them. Pure, real-time safe.
class Arming {
 public:
  Arming(const ArmingLimits& limits, Guards guards) : limits_(limits), guards_(guards) {}

  /// An action of the person. From disarmed to armed; in armed it lets a small force through at
  /// once. Anywhere else nothing.
  void arm() noexcept;
  /// From anywhere; a fault is forgotten.
  void disarm() noexcept;
  /// The force is dropped; after the pause it comes back slowly.
  void trip() noexcept;
  /// The force is dropped for good.
  void fail() noexcept;

  /// One tick. The share of the force to show, 0 to 1.
  /// @param elapsed since the last tick [s]
  /// @param fresh share that the age of the newest demand leaves: 1 fresh, 0 too old
  /// @param demand the force that would be shown [N]
  double step(double elapsed, double fresh, double demand) noexcept;

  FilterState state() const noexcept { return state_; }

 private:
  void drop(FilterState state) noexcept;

  ArmingLimits limits_;
  Guards guards_;
  FilterState state_ = FilterState::kDisarmed;
  bool action_ = false;  ///< armed by a person since the force was last dropped
  double share_ = 0.0;
  double pause_ = 0.0;  ///< what is left of it [s]
};

}  // namespace irdm
