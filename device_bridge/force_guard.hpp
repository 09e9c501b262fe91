#pragma once

#include <cstdint>
#include <optional>

#include "common/geometry.hpp"
#include "common/stylus.hpp"

namespace irdm {

/// What the servo loop knows of the server's forces for one stylus.
struct ServoInput {
  bool linked = false;     ///< a session is on
  bool any_force = false;  ///< `force` is of this session (or of the last one, when not linked)
  StylusForce force = {};  ///< the newest
};

struct GuardLimits {
  double max_force = 3.3;             ///< [N], > 0
  std::int64_t hold_ns = 50'000'000;  ///< a force of up to this age is shown in full
  std::int64_t fade_ns = 30'000'000;  ///< then it goes to zero, linearly, within this time
};

/// Last check before the device; preliminary, it limits magnitude and age and nothing else yet.
/// What is not finite becomes zero, what is too large is shortened, what is old fades, and so it
/// does at once when the link is lost. A force that comes back after that rises over the fade time.
class ForceGuard {
 public:
  explicit ForceGuard(const GuardLimits& limits) : limits_(limits) {}

  /// The force to show now [N], in the frame of input.force.force. Real-time safe.
  /// @param now_ns the clock of sample_time_ns, does not decrease
  Vector3 apply(std::int64_t now_ns, const ServoInput& input) noexcept;

  /// Forces that were not finite so far.
  std::uint64_t faults() const noexcept { return faults_; }

 private:
  double fade(std::int64_t now_ns) const noexcept;

  GuardLimits limits_;
  StylusForce held_;
  double gain_ = 1.0;
  std::optional<std::int64_t> last_ns_;
  std::optional<std::int64_t> lost_since_ns_;
  std::uint64_t faults_ = 0;
};

}  // namespace irdm
