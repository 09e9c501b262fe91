#pragma once

#include <string>

#include "replay/compare/measure_runs.hpp"

namespace irdm::replay {

/// The report of a comparison: one HTML page with its figures in it, which needs no network and no
/// script.
std::string comparison_html(const Comparison& comparison, const Measures& measures);

}  // namespace irdm::replay
