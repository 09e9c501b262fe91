#pragma once

#include <filesystem>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Reads the tetrahedra of a Medit file (.mesh, ASCII); coordinates as they are there. Vertices,
/// edges, triangles and tetrahedra that carry the same reference, other than 0, become a group
/// whose name is the section's keyword in lower case and the reference: "triangles 3". Throws Error
/// with file and line for other volume elements, unknown sections, truncated or damaged files.
TetMesh read_medit(const std::filesystem::path& path);

}  // namespace irdm::precompute
