#pragma once

#include <filesystem>
#include <optional>

#include "precompute/columns/column_file.hpp"
#include "precompute/config.hpp"
#include "precompute/parallel/ranks.hpp"
#include "precompute/progress.hpp"
#include "precompute/summary.hpp"

namespace irdm::precompute {

/// The whole way from a configuration to a model file: mesh, finite elements, modes, R. Warnings go
/// to stderr, progress to `console`. The file appears under its name only when it is complete.
/// Dense R by time stepping goes by way of a work file, so that an interrupted run can go on.
/// Throws Error.
/// @param slice only these columns of dense R: the output is a part for `merge`
/// @param ranks share the columns of dense R, or the lowest modes where SLEPc finds them; only rank
/// 0's summary is complete
Summary precompute_model(const PrecomputeConfig& config, const std::filesystem::path& output,
                         const Console& console, const std::optional<ColumnRange>& slice = {},
                         const Ranks& ranks = Ranks());

}  // namespace irdm::precompute
