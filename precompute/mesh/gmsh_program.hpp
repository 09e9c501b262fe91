#pragma once

#include <filesystem>
#include <string>

#include "precompute/mesh/surface_mesh.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Meshes a geometry script of Gmsh (.geo), which says its own sizes and physical groups, by the
/// program `gmsh`. Such a script is a program: it can run commands. Throws Error with the first
/// thing that gmsh complains of, or when the program is missing or takes longer than
/// `time_limit_s`.
/// @param program the program's name or path
TetMesh mesh_geometry(const std::filesystem::path& script, const std::string& program = "gmsh",
                      double time_limit_s = 120.0);

/// Makes new triangles with the given edge length on a closed surface and fills it with tetrahedra
/// of that size, by the program `gmsh`. Edges sharper than 40 degrees stay edges. Throws Error
/// (about `name`) as mesh_geometry does, when there are flat tetrahedra, and when the body loses or
/// gains more than a tenth of its volume.
/// @param surface that passed checked_surface
/// @param edge_length target, in the unit of the surface
TetMesh remesh_surface(const SurfaceMesh& surface, double edge_length, const std::string& name,
                       const std::string& program = "gmsh", double time_limit_s = 120.0);

}  // namespace irdm::precompute
