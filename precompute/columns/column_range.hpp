#pragma once

#include <string>

namespace irdm::precompute {

/// Columns begin <= b < end of R.
struct ColumnRange {
  int begin = 0;
  int end = 0;

  int count() const { return end - begin; }
  bool operator==(const ColumnRange&) const = default;
};

/// "A:B" as the command line has it, 0 <= A < B. Throws std::invalid_argument with a message.
ColumnRange column_range_from_text(const std::string& text);

std::string to_text(const ColumnRange& range);

/// The part of `range` that one of `size` equal workers does: the parts follow one another without
/// gap, differ by one block at most and begin at whole blocks, so that nothing is computed twice.
/// @param rank 0..size-1
/// @param block columns that are computed together, see ColumnSource
ColumnRange share_of(const ColumnRange& range, int rank, int size, int block);

}  // namespace irdm::precompute
