#pragma once

#include <string>

#include "replay/compare/measure_runs.hpp"

namespace irdm::replay {

/// A comparison with every frame, and what was measured of it, as JSON. The keys are documented in
/// docs/replay.md and stay.
std::string comparison_json(const Comparison& comparison, const Measures& measures);

}  // namespace irdm::replay
