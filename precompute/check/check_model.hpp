#pragma once

#include <filesystem>

#include "common/stability/coupling_limit.hpp"
#include "precompute/check/report.hpp"
#include "precompute/progress.hpp"

namespace irdm::precompute {

struct CheckOptions {
  Hand hand;
  double delay = -1.0;    ///< one way [s]; negative: one step
  double coupling = 0.0;  ///< virtual coupling that is going to be used [N/m]; 0: not said
};

/// Checks a model file and every response in it. What cannot be read is a line that fails. Dense R
/// is read column by column. Throws Error only when the file is not there, not HDF5, or of another
/// format.
Report check_model(const std::filesystem::path& path, const CheckOptions& options,
                   const Console& console);

}  // namespace irdm::precompute
