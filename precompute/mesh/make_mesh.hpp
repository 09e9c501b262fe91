#pragma once

#include "precompute/mesh/mesh_config.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// The tetrahedra that [mesh] asks for, checked.
struct MadeMesh {
  TetMesh mesh;          ///< coordinates in m
  int unused_nodes = 0;  ///< of the file, in no tetrahedron: left out
};

/// Throws Error.
MadeMesh make_mesh(const MeshConfig& config);

}  // namespace irdm::precompute
