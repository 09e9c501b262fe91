#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstddef>
#include <cstdint>

namespace irdm {

/// Every item counts: a bounded queue from one producer thread to one consumer thread. Memory is
/// taken at construction; a full queue refuses the item and counts it, nobody ever waits.
template <typename T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : queue_(capacity) {}

  /// Producer: false when the queue is full; the item is then lost and counted.
  bool push(const T& item) noexcept {
    if (queue_.push(item)) return true;
    overflows_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  /// Consumer: false when there is nothing to take.
  bool pop(T& item) noexcept { return queue_.pop(item); }

  /// Items lost so far; any thread.
  std::uint64_t overflows() const noexcept { return overflows_.load(std::memory_order_relaxed); }

 private:
  boost::lockfree::spsc_queue<T> queue_;
  std::atomic<std::uint64_t> overflows_{0};
};

}  // namespace irdm
