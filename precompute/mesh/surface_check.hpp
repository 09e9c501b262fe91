#pragma once

#include <string>

#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {

/// The surface with all triangles turned the same way round. Throws Error (about `name`, with the
/// place in the surface's own coordinates) unless it can bound a body: at least four triangles;
/// finite coordinates; closed and manifold, so that two triangles meet at every edge; one piece.
/// Self-intersection is left to check_self_intersection.
SurfaceMesh checked_surface(const SurfaceMesh& surface, const std::string& name);

}  // namespace irdm::precompute
