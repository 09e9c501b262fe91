#pragma once

#include <algorithm>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "device_bridge/safety/guards.hpp"

namespace irdm {

/// How good the link is: the share of the last kWindow ticks for which the newest demand was young
/// enough. Ticks that were not yet made count as bad. Pure, real-time safe.
class LinkGate {
 public:
  static constexpr std::size_t kWindow = 100;
  static constexpr double kNeeded = 0.90;  ///< success rate to arm with

  /// @param in_time whether the newest demand was young enough in this tick
  void tick(bool in_time) noexcept {
    if (ticks_[next_]) --good_;
    if (in_time) ++good_;
    ticks_[next_] = in_time;
    next_ = (next_ + 1) % kWindow;
  }
  /// 0 to 1.
  double success_rate() const noexcept {
    return static_cast<double>(good_) / static_cast<double>(kWindow);
  }

 private:
  std::bitset<kWindow> ticks_;
  std::size_t next_ = 0;
  std::size_t good_ = 0;
};

/// When a person who feels nothing, or not for long, should be told why: after so much more time on
/// a bad link than on a good one, within sessions, however many of them. Pure.
class ArmingPatience {
 public:
  static constexpr std::int64_t kPatienceNs = 5'000'000'000;

  /// Within a session. True when it is to be told; then not again for as long.
  /// @param now_ns monotonic  @param good every stylus is armed, and its link good enough to arm
  bool lost(std::int64_t now_ns, bool good) noexcept {
    const std::int64_t elapsed_ns = last_ns_ ? now_ns - *last_ns_ : 0;
    last_ns_ = now_ns;
    bad_ns_ = good ? std::max<std::int64_t>(bad_ns_ - elapsed_ns, 0) : bad_ns_ + elapsed_ns;
    if (bad_ns_ < kPatienceNs) return false;
    bad_ns_ = 0;
    return true;
  }
  /// The session is over: what follows until the next one does not count.
  void pause() noexcept { last_ns_.reset(); }

 private:
  std::optional<std::int64_t> last_ns_;
  std::int64_t bad_ns_ = 0;
};

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
