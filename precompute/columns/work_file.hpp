#pragma once

#include <filesystem>
#include <optional>

#include "precompute/columns/column_file.hpp"
#include "precompute/columns/column_source.hpp"
#include "precompute/parallel/ranks.hpp"
#include "precompute/progress.hpp"

namespace irdm::precompute {

/// Columns that are to be computed and what becomes of them.
struct ColumnWork {
  std::filesystem::path output;  ///< model file, or column file of a slice
  ColumnFileHeader header;       ///< with the columns that are wanted
  bool slice = false;            ///< the output is a column file
  int threads = 1;               ///< > 0
};

struct ColumnsDone {
  int computed = 0;                  ///< columns, by this process in this run
  std::optional<double> decay_left;  ///< see assemble(); none of a slice
};

/// Computes columns by way of a work file beside the output, OUTPUT.columns, that is kept when the
/// run is interrupted, by SIGKILL too: the same call goes on after the last column that it holds
/// whole, and what comes out is the same bit for bit. At most the columns that were being computed
/// are computed again. A work file of other content is given up. Ranks share the columns, each with
/// a work file of its own, and rank 0 joins them. Throws Error.
ColumnsDone write_by_columns(const ColumnSource& source, const ColumnWork& work, const Ranks& ranks,
                             const Console& console);

}  // namespace irdm::precompute
