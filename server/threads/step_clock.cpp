#include "server/threads/step_clock.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {

RealTimeClock::RealTimeClock(double dt)
    : period_ns_(std::llround(dt * 1e9)), schedule_(0, period_ns_) {}

bool RealTimeClock::wait(std::uint64_t step) noexcept {
  if (stopped()) return false;
  if (step == 0) {
    schedule_ = PeriodicSchedule(monotonic_ns(), period_ns_,
                                 std::llround(kCatchUp * kNanosecondsPerSecond) / period_ns_);
    return true;
  }
  const std::int64_t deadline = schedule_.next(monotonic_ns());
  sleep_until(deadline);
  last_delay_ = monotonic_ns() - deadline;
  wakeup_delay_.add(last_delay_);
  return !stopped();
}

LockstepClock::LockstepClock(NetworkServer& network, std::vector<StepSink*> sinks)
    : network_(network), sinks_(std::move(sinks)) {}

LockstepClock::Samples LockstepClock::samples(std::uint64_t step) noexcept {
  bool complete = true;
  for (int s = 0; s < network_.styluses(); ++s) {
    StylusPort& port = network_.port(s);
    port.in.receive();
    const StylusInput& input = port.in.front();
    if (!input.present && step > 0) return Samples::kEnded;
    complete = complete && input.present && input.sample.sequence == step;
  }
  return complete ? Samples::kComplete : Samples::kAwaited;
}

bool LockstepClock::room() const noexcept {
  return std::all_of(sinks_.begin(), sinks_.end(),
                     [](const StepSink* sink) { return sink->has_room(); });
}

// The step that wait() has let through would come at once again.
void LockstepClock::rest() noexcept {
  network_.serve();
}

bool LockstepClock::wait(std::uint64_t step) noexcept {
  while (!stopped() && !room()) network_.serve();
  while (!stopped()) {
    switch (samples(step)) {
      case Samples::kComplete:
        return true;
      case Samples::kEnded:
        return false;
      case Samples::kAwaited:
        network_.serve();
    }
  }
  return false;
}

}  // namespace irdm
