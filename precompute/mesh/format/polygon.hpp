#pragma once

#include <array>
#include <vector>

#include "common/geometry.hpp"

namespace irdm::precompute {

/// Cuts a flat polygon into triangles that keep its turn: a convex one from its first corner, a
/// concave one by clipping ears (Meisters 1975). Corners may lie on one line.
/// @param corners at least three, in order [any unit]
/// @return corners.size() - 2 triangles, as numbers of corners
std::vector<std::array<int, 3>> cut_polygon(const std::vector<Vector3>& corners);

}  // namespace irdm::precompute
