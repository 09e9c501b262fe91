#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "common/realtime/triple_buffer.hpp"
#include "server/network/stylus_slots.hpp"
#include "server/threads/step_queue.hpp"
#include "simulation/step/settings.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// The way of the steps from the force thread to another one that needs every step (the recorder,
/// the deformation). The force thread never waits for it in real time; what does not fit is
/// counted.
class StepSink {
 public:
  /// @param capacity, shape as of StepQueue
  explicit StepSink(std::size_t capacity, const StepShape& shape = {}) : queue_(capacity, shape) {}

  /// Force thread.
  void put(const StepRecord& record) noexcept {
    if (!open_.load(std::memory_order_acquire) || queue_.push(record)) return;
    lost_.fetch_add(1, std::memory_order_relaxed);
  }
  /// Force thread, lockstep only: false as long as the next record would be lost.
  bool has_room() const noexcept {
    return !open_.load(std::memory_order_acquire) || queue_.has_room();
  }
  /// The other thread: the next step, if there is one. As copy_step().
  bool take(StepRecord& record) noexcept { return queue_.pop(record); }
  /// Whether steps are taken in, true at first. A step under way when it is closed may still come.
  void set_open(bool open) noexcept { open_.store(open, std::memory_order_release); }
  /// Steps lost because the other thread was too slow; any thread.
  std::uint64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  StepQueue queue_;
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<bool> open_{true};
};

/// What someone beside the run (a viewer) asks of the force thread. One such thread, one force
/// thread; neither ever waits for the other.
class RunControl {
 public:
  explicit RunControl(const Settings& settings) : settings_(settings) {}

  /// Puts everything back to the start before the next step; requests until then are one.
  void request_reset() noexcept { reset_.store(true, std::memory_order_relaxed); }
  /// No step is made until resume(), but those that are asked for.
  void pause() noexcept {
    steps_.store(0, std::memory_order_relaxed);
    paused_.store(true, std::memory_order_relaxed);
  }
  void resume() noexcept { paused_.store(false, std::memory_order_relaxed); }
  bool paused() const noexcept { return paused_.load(std::memory_order_relaxed); }
  /// So many more steps while paused.
  void request_steps(std::uint32_t count) noexcept {
    steps_.fetch_add(count, std::memory_order_relaxed);
  }
  /// From the next step on; they must have passed check_settings().
  void set(const Settings& settings) noexcept { settings_.put(settings); }
  /// Where the viewers' stylus is; not present: nobody has it.
  TripleBuffer<StylusInput>& stylus() noexcept { return stylus_; }

  // Force thread.
  bool take_reset() noexcept {
    return reset_.load(std::memory_order_relaxed) &&
           reset_.exchange(false, std::memory_order_relaxed);
  }
  /// False: no step now.
  bool take_step() noexcept {
    if (!paused()) return true;
    if (steps_.load(std::memory_order_relaxed) == 0) return false;
    steps_.fetch_sub(1, std::memory_order_relaxed);
    return true;
  }
  /// The newest settings if there are new ones, else null.
  const Settings* take_settings() noexcept {
    return settings_.receive() ? &settings_.front() : nullptr;
  }

 private:
  std::atomic<bool> reset_{false};
  std::atomic<bool> paused_{false};
  std::atomic<std::uint32_t> steps_{0};
  TripleBuffer<Settings> settings_;
  TripleBuffer<StylusInput> stylus_;
};

}  // namespace irdm
