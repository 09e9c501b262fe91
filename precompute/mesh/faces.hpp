#pragma once

#include <array>
#include <map>
#include <vector>

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

}  // namespace irdm::precompute
