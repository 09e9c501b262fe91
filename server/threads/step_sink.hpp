#pragma once

#include <atomic>
#include <cstddef>

#include "common/realtime/bounded_queue.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// The way of the steps from the force thread to another one that needs every step (the recorder,
/// the deformation). The force thread never waits for it in real time; what does not fit is
/// counted.
class StepSink {
 public:
  explicit StepSink(std::size_t capacity) : queue_(capacity) {}

  /// Force thread.
  void put(const StepRecord& record) noexcept {
    if (open_.load(std::memory_order_acquire)) queue_.push(record);
  }
  /// Force thread, lockstep only: false as long as the next record would be lost.
  bool has_room() const noexcept {
    return !open_.load(std::memory_order_acquire) || queue_.room() > 0;
  }
  /// The other thread: the next step, if there is one.
  bool take(StepRecord& record) noexcept { return queue_.pop(record); }
  /// Whether steps are taken in, true at first. A step under way when it is closed may still come.
  void set_open(bool open) noexcept { open_.store(open, std::memory_order_release); }
  /// Steps lost because the other thread was too slow; any thread.
  std::uint64_t lost() const noexcept { return queue_.overflows(); }

 private:
  BoundedQueue<StepRecord> queue_;
  std::atomic<bool> open_{true};
};

}  // namespace irdm
