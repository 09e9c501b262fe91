#pragma once

#include <filesystem>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Reads a tetrahedral mesh, in a format told by the file's extension: .msh (Gmsh), .node or .ele
/// (TetGen). Throws Error. The mesh is not checked yet: see check_mesh.
TetMesh read_mesh_file(const std::filesystem::path& path);

}  // namespace irdm::precompute
