#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// The four faces of a tetrahedron as local corner numbers, counter-clockwise seen from outside.
inline constexpr std::array<std::array<int, 3>, 4> kTetFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// A face of one element.
struct TetFace {
  int tet;
  int face;  ///< 0..3, into kTetFaces
};

/// Corners of a face, outward.
inline std::array<int, 3> face_nodes(const TetMesh& mesh, const TetFace& f) {
  const auto& corners = kTetFaces[static_cast<std::size_t>(f.face)];
  return {mesh.tets(f.tet, corners[0]), mesh.tets(f.tet, corners[1]), mesh.tets(f.tet, corners[2])};
}

/// The triangles of nodes that a face consists of, outward: one in a linear mesh; in a quadratic
/// one four, at the three corners and last in the middle.
std::vector<std::array<int, 3>> face_triangles(const TetMesh& mesh, const TetFace& f);

/// Which element faces share each triple of corners (sorted): one for the boundary, two inside.
std::map<std::array<int, 3>, std::vector<TetFace>> faces_by_nodes(const TetMesh& mesh);

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
