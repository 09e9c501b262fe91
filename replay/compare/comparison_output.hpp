#pragma once

#include <string>

#include "replay/compare/measure_runs.hpp"

namespace irdm::replay {

/// A table for people, with one line for each thing that a hand would notice.
std::string comparison_table(const Comparison& comparison, const Measures& measures);

/// A comparison with every frame, and what was measured of it, as JSON. The keys are documented in
/// docs/replay.md and stay.
std::string comparison_json(const Comparison& comparison, const Measures& measures);

}  // namespace irdm::replay
