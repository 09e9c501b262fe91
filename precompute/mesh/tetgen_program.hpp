#pragma once

#include <string>

#include "precompute/mesh/surface_mesh.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Fills the surface of a box with tetrahedra by the program `tetgen` (flags -pYq1.1: the surface
/// is kept as it is). The first nodes of the mesh are those of the surface, unchanged. Throws Error
/// when the program is missing, fails, takes longer than `time_limit_s` or changes the surface.
/// @param program the program's name or path
TetMesh tetrahedralise(const SurfaceMesh& surface, const std::string& program = "tetgen",
                       double time_limit_s = 120.0);

/// The same for any closed surface, with tetrahedra inside that are about as large as its
/// triangles. `name` stands for it in messages, `remedy` says what to do where it cannot be filled.
TetMesh fill_surface(
    const SurfaceMesh& surface, const std::string& name, const std::string& program = "tetgen",
    double time_limit_s = 120.0,
    const std::string& remedy = "set mesh.edge_length, which makes its triangles anew");

/// Throws Error (about `name`, with a place in the surface's own coordinates) when triangles cut or
/// overlap each other, as `tetgen -d` finds; and when that program is missing or fails.
void check_self_intersection(const SurfaceMesh& surface, const std::string& name,
                             const std::string& program = "tetgen", double time_limit_s = 120.0);

}  // namespace irdm::precompute
