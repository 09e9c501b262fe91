#pragma once

#include <string>
#include <vector>

#include "replay/compare/measure_runs.hpp"

namespace irdm::replay {

/// A table for people.
std::string comparison_table(const Comparison& comparison, const Measures& measures);

/// What a hand would notice of the differences on a stylus, one line each.
std::vector<std::string> perceptual_findings(const StylusMeasures& stylus, const Measures& measures,
                                             const std::vector<double>& times);

}  // namespace irdm::replay
