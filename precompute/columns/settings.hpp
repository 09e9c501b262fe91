#pragma once

#include <string>
#include <vector>

#include "precompute/config.hpp"

namespace irdm::precompute {

/// All that R depends on beside mesh, material, time axis and precision, one "name value" a line:
/// method, clamped nodes, time stepping. Slices of R fit together only where this is the same.
std::string settings_text(const PrecomputeConfig& config, const std::vector<int>& clamped);

}  // namespace irdm::precompute
