#pragma once

#include <filesystem>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Reads the linear tetrahedra of a Gmsh file, MSH 2.2 or 4.1, ASCII; coordinates as they are
/// there. Points, lines and surface elements are passed over, but for the physical groups that they
/// belong to, which become the mesh's groups; those without a name go by their number. Nodes keep
/// the order of the file. Throws Error with file and line for other versions, binary files, other
/// or second-order volume elements (quadratic_mesh makes those), truncated or damaged files.
TetMesh read_gmsh(const std::filesystem::path& path);

}  // namespace irdm::precompute
