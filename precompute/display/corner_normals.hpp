#pragma once

#include <set>
#include <utility>

#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {

/// How a surface of triangles is shaded. t triangles.
struct Shading {
  Points normals;                         ///< (3t, 3) unit, of each corner of each triangle
  std::set<std::pair<int, int>> creases;  ///< edges that stay sharp: nodes, the lower one first
};

/// Smooth normals (exact on a sphere) of the triangles round a node that can be reached from each
/// other over edges that are no creases. A crease is an edge whose triangles are inclined to each
/// other by more than an angle, or that has not two triangles, and that belongs to a line of such
/// edges without an end.
/// @param surface with every place there once
/// @param crease_angle [rad]
Shading smooth_shading(const SurfaceMesh& surface, double crease_angle);

}  // namespace irdm::precompute
