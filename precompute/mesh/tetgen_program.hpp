#pragma once

#include <string>

#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Fills a closed surface with tetrahedra by the program `tetgen` (flags -pYq1.1: the surface is
/// kept as it is). The first nodes of the mesh are those of the surface, unchanged. Throws Error
/// when the program is missing, fails, takes longer than `time_limit_s` or changes the surface.
/// @param program the program's name or path
TetMesh tetrahedralise(const BoxSurface& surface, const std::string& program = "tetgen",
                       double time_limit_s = 120.0);

}  // namespace irdm::precompute
