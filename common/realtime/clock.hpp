#pragma once

#include <cstdint>

namespace irdm {

inline constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
inline constexpr double kNanosecond = 1e-9;  // [s]
/// Longest overrun of the server whose steps are made up for, in real and in simulated time [s].
inline constexpr double kCatchUp = 0.02;

/// Monotonic time of this machine [ns]. Any thread, real-time safe.
std::int64_t monotonic_ns() noexcept;

/// Sleeps until monotonic_ns() reaches `deadline_ns`.
void sleep_until(std::int64_t deadline_ns) noexcept;

/// Absolute deadlines of a periodic loop: no drift. Of periods that are over when the loop comes
/// back a few are made up for at once; more than that are skipped whole. All are counted.
class PeriodicSchedule {
 public:
  /// @param start_ns start of the first period
  /// @param period_ns > 0
  /// @param most_behind periods that are made up for, at most
  PeriodicSchedule(std::int64_t start_ns, std::int64_t period_ns,
                   std::int64_t most_behind = 0) noexcept
      : period_ns_(period_ns), most_behind_(most_behind), deadline_ns_(start_ns) {}

  /// The start of the period to wait for, given the time now: the next one that is not over yet, or
  /// is made up for. One that starts late but has not ended still runs.
  std::int64_t next(std::int64_t now_ns) noexcept;
  std::uint64_t missed() const noexcept { return missed_; }
  std::uint64_t made_up() const noexcept { return made_up_; }  ///< of the missed ones
  /// Whether the period of the last next() is one of these.
  bool behind() const noexcept { return behind_; }

 private:
  std::int64_t period_ns_;
  std::int64_t most_behind_;
  std::int64_t deadline_ns_;
  std::uint64_t missed_ = 0;
  std::uint64_t made_up_ = 0;
  bool behind_ = false;
};

}  // namespace irdm
