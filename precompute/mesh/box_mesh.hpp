#pragma once

#include <array>

#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {

/// The surface of an axis-parallel box with one corner at the origin: a regular grid on each face,
/// every cell split into two triangles whose diagonals alternate like a chessboard. Normals
/// outward.
/// @param size edge lengths [m], > 0
/// @param cells cells along each edge, >= 1
SurfaceMesh box_surface(const Vector3& size, const std::array<int, 3>& cells);

}  // namespace irdm::precompute
