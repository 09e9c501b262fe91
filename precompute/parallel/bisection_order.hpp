#pragma once

#include <vector>

#include "common/geometry.hpp"

namespace irdm::precompute {

/// An order of the points in which any run of neighbours lies close together: halved along the
/// longest axis, again and again (recursive coordinate bisection). So processes that each take a
/// run of them have little surface in common. The same points give the same order.
/// @param points (n, 3)
/// @return (n), which point comes where
std::vector<int> bisection_order(const Points& points);

}  // namespace irdm::precompute
