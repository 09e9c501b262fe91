#pragma once

#include <filesystem>

#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {

/// Reads the triangles of an STL file, ASCII (all its solids) or binary; every triangle has three
/// nodes of its own, as in the file: see weld. Normals are passed over. Throws Error for truncated
/// or damaged files.
SurfaceMesh read_stl(const std::filesystem::path& path);

}  // namespace irdm::precompute
