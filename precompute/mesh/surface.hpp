#pragma once

#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// The boundary of a tetrahedral mesh. n surface nodes, t triangles.
struct Surface {
  std::vector<int> nodes;  ///< (n) into the mesh's nodes, increasing
  Triangles triangles;     ///< (t, 3) into `nodes`, normals outward
};

/// Faces that belong to exactly one tetrahedron, as triples of corners seen from outside
/// counter-clockwise, in the order of the elements. Throws Error (about `name`) when a face belongs
/// to more than two tetrahedra or to two that overlap. Volumes must be positive.
Triangles boundary_faces(const TetMesh& mesh, const std::string& name);

/// The boundary with its own node numbering. In a quadratic mesh the mid-side nodes belong to it
/// and each face is four triangles.
Surface extract_surface(const TetMesh& mesh, const std::string& name);

}  // namespace irdm::precompute
