#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "common/realtime/clock.hpp"
#include "common/realtime/histogram.hpp"
#include "server/network/network_server.hpp"
#include "server/threads/run_control.hpp"

namespace irdm {

/// Tells the force thread when a step may run: what --lockstep replaces.
class StepClock {
 public:
  virtual ~StepClock() = default;
  /// Returns when step k may run; false when there is to be no further step. Force thread.
  virtual bool wait(std::uint64_t step) noexcept = 0;
  /// In place of a step: returns after a moment. Force thread.
  virtual void rest() noexcept {}
  /// Whether time is simulated.
  virtual bool lockstep() const noexcept { return false; }
  /// How late the last wait() ended [ns]; -1: no such thing. Force thread.
  virtual std::int64_t last_delay() const noexcept { return -1; }
  /// Steps so far that could not begin within their period. Force thread, or after the run.
  virtual std::uint64_t missed() const noexcept { return 0; }
  /// Whether the step that wait() has let through is one of these, and more are to follow at once.
  virtual bool behind() const noexcept { return false; }
  /// Ends the wait; any thread.
  void stop() noexcept { stopped_.store(true, std::memory_order_relaxed); }

 protected:
  bool stopped() const noexcept { return stopped_.load(std::memory_order_relaxed); }

 private:
  std::atomic<bool> stopped_{false};
};

/// One step every dt of the machine's clock, at absolute times from the first step on. After an
/// overrun of at most kCatchUp the steps of the periods missed are made at once, so that the object
/// stays with the hands; after a longer one they are left out.
class RealTimeClock final : public StepClock {
 public:
  explicit RealTimeClock(double dt);
  bool wait(std::uint64_t step) noexcept override;
  /// How late the thread was for each step, those made up for as well [ns]; after the run.
  const Histogram& wakeup_delay() const noexcept { return wakeup_delay_; }
  std::int64_t last_delay() const noexcept override { return last_delay_; }
  std::uint64_t missed() const noexcept override { return schedule_.missed(); }
  bool behind() const noexcept override { return schedule_.behind(); }
  /// Of the missed steps those that were made all the same.
  std::uint64_t made_up() const noexcept { return schedule_.made_up(); }

 private:
  std::int64_t period_ns_;
  PeriodicSchedule schedule_;
  Histogram wakeup_delay_;
  std::int64_t last_delay_ = -1;
};

/// Step k runs when sample k of every stylus is there; the run is over when a stylus leaves. Waits
/// for the followers too, so that no step is lost however fast simulated time goes.
class LockstepClock final : public StepClock {
 public:
  /// The force thread's side of `network`, which has to be open, and of the sinks; they must
  /// outlive the clock.
  LockstepClock(NetworkServer& network, std::vector<StepSink*> sinks);
  bool wait(std::uint64_t step) noexcept override;
  void rest() noexcept override;
  bool lockstep() const noexcept override { return true; }

 private:
  enum class Samples { kComplete, kAwaited, kEnded };
  Samples samples(std::uint64_t step) noexcept;
  bool room() const noexcept;

  NetworkServer& network_;
  std::vector<StepSink*> sinks_;
};

}  // namespace irdm
