#pragma once

#include <algorithm>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "common/blackbox/black_box.hpp"
#include "common/hdf5/file.hpp"
#include "common/realtime/bounded_queue.hpp"

namespace irdm {

/// Writes one column of a black box: `width` numbers of each row, which `fill` writes.
/// @param unit attribute of the column; empty: none
template <typename T, typename Row, typename Fill>
void write_column(hdf5::File& file, const std::string& path, const std::string& unit,
                  std::size_t width, const std::vector<const Row*>& rows, const Fill& fill) {
  std::vector<T> values(rows.size() * width);
  for (std::size_t k = 0; k < rows.size(); ++k) fill(*rows[k], values.data() + k * width);
  hdf5::Shape shape{rows.size()};
  if (width > 1) shape.push_back(width);
  file.write<T>(path, shape, values.data());
  if (!unit.empty()) file.write_attribute(path, "unit", unit);
}

/// The columns of one group, one after the other.
template <typename Row>
class ColumnGroup {
 public:
  ColumnGroup(hdf5::File& file, std::string group, std::vector<const Row*> rows)
      : file_(file), group_(std::move(group)), rows_(std::move(rows)) {}

  /// @param value of a row
  template <typename T, typename Value>
  void number(const char* name, const std::string& unit, const Value& value) {
    write_column<T>(file_, group_ + "/" + name, unit, 1, rows_,
                    [&](const Row& row, T* out) { *out = static_cast<T>(value(row)); });
  }
  /// @param value a vector of three numbers
  template <typename Value>
  void vector(const char* name, const std::string& unit, const Value& value) {
    write_column<double>(file_, group_ + "/" + name, unit, 3, rows_,
                         [&](const Row& row, double* out) {
                           for (int axis = 0; axis < 3; ++axis) out[axis] = value(row)[axis];
                         });
  }
  /// Of a time on monotonic_ns()'s clock: seconds from the origin.
  template <typename Value>
  void time(const char* name, std::int64_t origin_ns, const Value& value) {
    number<double>(name, "s", [&](const Row& row) {
      return 1e-9 * static_cast<double>(value(row) - origin_ns);
    });
  }

 private:
  hdf5::File& file_;
  std::string group_;
  std::vector<const Row*> rows_;
};

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
