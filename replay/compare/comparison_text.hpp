#pragma once

#include <string>

#include "replay/compare/compare_runs.hpp"

namespace irdm::replay {

/// A table for people.
std::string comparison_table(const Comparison& comparison);

/// The same with every frame, as JSON (docs/replay.md).
std::string comparison_json(const Comparison& comparison);

}  // namespace irdm::replay
