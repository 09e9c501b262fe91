#pragma once

#include <algorithm>
#include <cstddef>
#include <variant>

#include "common/model/model.hpp"
#include "precompute/columns/column_file.hpp"

namespace irdm::precompute {

/// Columns of R one below the other, in the precision of the file: rows [b][s], (count * T, 3n)
/// [m/N].
using Columns = std::variant<RowMatrix<float>, RowMatrix<double>>;

/// Where columns of R come from. They are computed in blocks that start at multiples of the block's
/// size, whichever of them are wanted: the bits of a column depend neither on the slice that it is
/// part of nor on where an interrupted run went on.
class ColumnSource {
 public:
  virtual ~ColumnSource() = default;
  virtual int columns() const = 0;     ///< of R, 3n
  virtual int block_size() const = 0;  ///< > 0; the last block may be smaller
  /// Block k = 0, 1, ... For any number of threads at a time.
  virtual Columns block(int k) const = 0;
  /// Whether there is a response to the body's own spin besides.
  virtual bool has_centrifugal() const { return false; }
  /// That response, columns like those of R for the six SpinProducts: rows [product][s]. Without
  /// any, no rows.
  virtual Columns centrifugal() const { return {}; }
  /// Whether there is a response to gravity besides.
  virtual bool has_gravity() const { return false; }
  /// What accelerations of 1 m/s^2 along each axis of B that set in and stay lead to: rows
  /// [axis][s] [m]. Without any, no rows.
  virtual Columns gravity() const { return {}; }

  ColumnRange block_range(int k) const {
    return {k * block_size(), std::min((k + 1) * block_size(), columns())};
  }
};

/// Columns of a block: `most`, fewer where they would take more than about 128 MB.
inline int limited_block_size(int most, int steps, int degrees_of_freedom, std::size_t number) {
  constexpr double kBlockBytes = 128e6;
  const double column =
      static_cast<double>(steps) * degrees_of_freedom * static_cast<double>(number);
  return static_cast<int>(std::clamp(kBlockBytes / column, 1.0, static_cast<double>(most)));
}

}  // namespace irdm::precompute
