#include "common/realtime/clock.hpp"

#include <algorithm>
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
  const std::int64_t over = std::max<std::int64_t>(0, (now_ns - deadline_ns_) / period_ns_);
  behind_ = over > 0 && over <= most_behind_;
  if (behind_) {
    ++missed_;
    ++made_up_;
  } else {
    deadline_ns_ += over * period_ns_;
    missed_ += static_cast<std::uint64_t>(over);
  }
  return deadline_ns_;
}

}  // namespace irdm
