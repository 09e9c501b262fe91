#pragma once

#include <cstdint>
#include <optional>

#include "common/motion/wrench.hpp"
#include "device_bridge/safety/guards.hpp"
#include "device_bridge/safety/velocity_estimate.hpp"

namespace irdm {

struct ReadingLimits {
  double resolution = 0.0;   ///< steps in which the tip comes, as noise has them, too [m]
  double farthest = 2.0;     ///< of a tip from the device's origin [m]
  double top_speed = 1.0;    ///< of a hand that feels a force [m/s] ...
  int speed_ticks = 3;       ///< ... exceeded in so many ticks in a row, the force is dropped
  double jump = 0.01;        ///< between two readings [m] ...
  double jump_speed = 10.0;  ///< ... at such a speed is no hand's way [m/s]
  int bad_ticks = 3;         ///< readings of no use in a row that are a fault
  std::int64_t gap_ns = 50'000'000;  ///< a longer time between two ticks drops the force
  bool turns = false;                ///< the orientation counts as well, a turn as a way of kLever
};

/// What a reading of the device means for the force.
enum class ReadingVerdict {
  kGood,
  kUnused,  ///< the last good one stands
  kTrip,    ///< drop the force; it may come back slowly
  kFault,   ///< drop the force for good
};

/// Sanity of what the device says, and of the time at which it says it. Pure, real-time safe.
class SensorPlausibility {
 public:
  SensorPlausibility(const ReadingLimits& limits, Guards guards)
      : limits_(limits), guards_(guards), estimate_(limits.resolution) {}

  /// Once a tick.
  /// @param tip [m], D; anything  @param orientation in D; anything
  ReadingVerdict look(std::int64_t now_ns, const Vector3& tip,
                      const Quaternion& orientation) noexcept;

  /// The same of a reading that is the last one once more: it says nothing of a speed, and the next
  /// one has the way of both. After a gap it is of no use.
  ReadingVerdict repeat(std::int64_t now_ns) noexcept;

  /// Of the last good reading.
  const Vector3& tip() const noexcept { return tip_; }
  /// The same; where turns do not count, the identity.
  const Quaternion& orientation() const noexcept { return orientation_; }
  /// Since the good reading before it; zero when the reading was not used. No turn where turns do
  /// not count.
  const Twist& displacement() const noexcept { return displacement_; }
  /// Zero when the reading was not used; of the tip by VelocityEstimate.
  const Twist& velocity() const noexcept { return velocity_; }
  /// Since the last tick [s], 0 to the longest gap.
  double elapsed() const noexcept { return elapsed_; }
  std::uint64_t unused() const noexcept { return unused_; }  ///< so far

 private:
  ReadingVerdict look_at_clock(std::int64_t now_ns) noexcept;
  ReadingVerdict look_at_pose(std::int64_t now_ns, const Vector3& tip,
                              const Quaternion& orientation) noexcept;
  bool sane(const Vector3& tip, const Quaternion& orientation) const noexcept;
  ReadingVerdict look_at_speed(const Twist& raw) noexcept;
  ReadingVerdict leave_out() noexcept;

  ReadingLimits limits_;
  Guards guards_;
  VelocityEstimate estimate_;
  std::optional<std::int64_t> last_ns_;       ///< of the last tick
  std::optional<std::int64_t> last_good_ns_;  ///< of the last good reading
  Vector3 tip_ = Vector3::Zero();
  Quaternion orientation_ = Quaternion::Identity();
  Twist displacement_;
  Twist velocity_;
  double elapsed_ = 0.0;
  int bad_ = 0;
  int fast_ = 0;
  std::uint64_t unused_ = 0;
};

}  // namespace irdm
