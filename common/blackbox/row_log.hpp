#pragma once

#include <algorithm>
#include <deque>

#include "common/blackbox/black_box_part.hpp"
#include "common/realtime/bounded_queue.hpp"

namespace irdm {

/// The rows that one real-time thread writes down, one after the other. A row has a time_ns.
template <typename Row>
class RowLog : public BlackBoxPart {
 public:
  /// @param capacity of the queue: rows between two looks of the black box
  explicit RowLog(std::size_t capacity) : queue_(capacity) {}

  /// The real-time thread. What does not fit is lost and counted.
  void put(const Row& row) noexcept { queue_.push(row); }

  std::optional<Fault> take() override {
    std::optional<Fault> first;
    Row row;
    while (queue_.pop(row)) {
      std::optional<Fault> fault = look(row);
      if (fault && !first) first = std::move(fault);
      rows_.push_back(row);
    }
    return first;
  }
  void forget(std::int64_t now_ns) override {
    if (rows_.empty()) return;
    const std::int64_t end_ns = std::min(now_ns, rows_.back().time_ns);
    while (end_ns - rows_.front().time_ns > kKeptNs) rows_.pop_front();
  }

 protected:
  /// Whether something is wrong in this row, which comes after those that were shown before.
  virtual std::optional<Fault> look(const Row& row) = 0;
  const std::deque<Row>& rows() const noexcept { return rows_; }
  std::uint64_t lost() const noexcept { return queue_.overflows(); }

 private:
  BoundedQueue<Row> queue_;
  std::deque<Row> rows_;
};

}  // namespace irdm
