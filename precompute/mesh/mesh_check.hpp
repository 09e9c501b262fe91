#pragma once

#include <string>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// Throws Error unless the mesh is one that can be computed with: at least one element; finite
/// coordinates; indices in range and distinct within an element; every node used; volumes positive
/// and not vanishing; one piece, joined through faces; a closed surface in which two triangles meet
/// at every edge. `name` stands for the mesh in the messages, which count elements and nodes from 1
/// in the order of the mesh.
void check_mesh(const TetMesh& mesh, const std::string& name);

}  // namespace irdm::precompute
