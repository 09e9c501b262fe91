#pragma once

#include <optional>
#include <string>

#include "common/model/model.hpp"

namespace irdm {

/// What is wrong with a model, its response left aside: numbers are finite and within
/// lab_ranges.hpp, indices in range, elements not flat, the surface is closed and its triangles
/// face outward, masses are positive and add up, and the inertia is symmetric and positive
/// definite. Nothing when all of that holds.
std::optional<std::string> description_fault(const Model& model);

}  // namespace irdm
