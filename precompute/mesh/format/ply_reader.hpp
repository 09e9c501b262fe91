#pragma once

#include <filesystem>

#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {

/// Reads the vertices and faces of a PLY file, ASCII or binary of either byte order; polygons are
/// cut into triangles; other elements and properties are passed over. Throws Error with file and
/// line for truncated or damaged files.
SurfaceMesh read_ply(const std::filesystem::path& path);

}  // namespace irdm::precompute
