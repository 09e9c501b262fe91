#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/hdf5/file.hpp"

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

}  // namespace irdm
