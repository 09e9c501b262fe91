#include "common/realtime/clock.hpp"

#include <cerrno>
#include <ctime>

namespace irdm {
namespace {}

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kNanosecondsPerSecond + now.tv_nsec;
}

void sleep_until(std::int64_t deadline_ns) noexcept {
  const timespec deadline{deadline_ns / kNanosecondsPerSecond, deadline_ns % kNanosecondsPerSecond};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
  }
}

std::int64_t PeriodicSchedule::next(std::int64_t now_ns) noexcept {
  deadline_ns_ += period_ns_;
  const std::int64_t late = now_ns - deadline_ns_;
  if (late >= period_ns_) {
    const std::int64_t skipped = late / period_ns_;
    deadline_ns_ += skipped * period_ns_;
    missed_ += static_cast<std::uint64_t>(skipped);
  }
  return deadline_ns_;
}

}  // namespace irdm
