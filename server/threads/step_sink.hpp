#pragma once

#include <cstddef>

#include "common/realtime/bounded_queue.hpp"
#include "server/step/step_record.hpp"

namespace irdm {

/// The way of the steps from the force thread to another one that needs every step (the recorder,
/// the deformation). The force thread never waits for it in real time; what does not fit is
/// counted.
class StepSink {
 public:
  explicit StepSink(std::size_t capacity) : queue_(capacity) {}

  /// Force thread.
  void put(const StepRecord& record) noexcept { queue_.push(record); }
  /// Force thread, lockstep only: false as long as the next record would be lost.
  bool has_room() const noexcept { return queue_.room() > 0; }
  /// The other thread: the next step, if there is one.
  bool take(StepRecord& record) noexcept { return queue_.pop(record); }
  /// Steps lost because the other thread was too slow; any thread.
  std::uint64_t lost() const noexcept { return queue_.overflows(); }

 private:
  BoundedQueue<StepRecord> queue_;
};

}  // namespace irdm
