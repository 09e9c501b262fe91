#pragma once

#include <filesystem>
#include <optional>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Reads a tetrahedral mesh or makes one, in a way told by the file's extension (docs/meshes.md):
/// .msh (Gmsh), .node or .ele (TetGen), .vtk, .vtu, .mesh (Medit); .stl, .obj and .ply are surfaces
/// that are filled with tetrahedra; a .geo is meshed by gmsh. Coordinates as they are in the file.
/// Throws Error. The mesh is not checked yet: see check_mesh.
/// @param edge_length of the tetrahedra of a surface, whose triangles are then made anew, in the
/// file's unit, > 0; none: its own triangles are kept. Not for other files.
TetMesh read_mesh_file(const std::filesystem::path& path,
                       std::optional<double> edge_length = std::nullopt);

/// Whether the extension is that of a surface.
bool is_surface_file(const std::filesystem::path& path);

}  // namespace irdm::precompute
