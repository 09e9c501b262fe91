#pragma once

#include <string>
#include <vector>

#include "precompute/columns/column_source.hpp"
#include "precompute/config.hpp"

namespace irdm::precompute {

/// All that R depends on beside mesh, material, time axis and precision, one "name value" a line:
/// method, clamped nodes, time stepping. Slices of R fit together only where this is the same.
std::string settings_text(const PrecomputeConfig& config, const std::vector<int>& clamped);

/// Where finished columns go: (T, 3n) numbers each, in the order of the columns, by one thread at a
/// time.
class ColumnStore {
 public:
  virtual ~ColumnStore() = default;
  virtual void put(int b, const float* values) = 0;
  virtual void put(int b, const double* values) = 0;
  /// After the last column of each block.
  virtual void flush() {}
};

/// Computes the columns of `range` and stores them in order, several blocks at a time on as many
/// threads; while one thread stores, the others compute. BLAS is kept to one thread meanwhile.
/// Throws what the source or the store throws; what was stored until then stays.
/// @param threads > 0
void compute_columns(const ColumnSource& source, const ColumnRange& range, int threads,
                     ColumnStore& store);

}  // namespace irdm::precompute
