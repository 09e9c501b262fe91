#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "common/model/model.hpp"

namespace irdm::precompute {

/// The six edges of a tetrahedron as local corner numbers. A quadratic tetrahedron has a node in
/// the middle of each, numbered 4..9 in this order, which is VTK's (VTK_QUADRATIC_TETRA). Gmsh's
/// order is the same but for the last two, which are exchanged there.
inline constexpr std::array<std::array<int, 2>, 6> kTetEdges{
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

/// Points, edges, faces or tetrahedra that the maker of a mesh named together: the nodes of each.
using MeshGroup = std::vector<std::vector<int>>;

/// A mesh of tetrahedra, all linear or all quadratic, with straight edges. N nodes, E elements. The
/// corners of an element (a, b, c, d) are ordered so that (b-a) x (c-a) points towards d: positive
/// volume. They come first; in a quadratic element the mid-side nodes follow (see kTetEdges).
struct TetMesh {
  Points nodes;                             ///< (N, 3) [m], coordinates of the input
  RowMatrix<int> tets;                      ///< (E, 4 or 10), into nodes
  std::map<std::string, MeshGroup> groups;  ///< by name; most formats have none

  int node_count() const { return static_cast<int>(nodes.rows()); }
  int tet_count() const { return static_cast<int>(tets.rows()); }
  /// 1: linear, 2: quadratic.
  int order() const { return tets.cols() == 10 ? 2 : 1; }
  /// Position of a node [m].
  Vector3 position(int node) const { return nodes.row(node).transpose(); }
};

/// Signed volume of tetrahedron e [m^3].
inline double signed_volume(const TetMesh& mesh, int e) {
  const Vector3 a = mesh.position(mesh.tets(e, 0));
  const Vector3 ab = mesh.position(mesh.tets(e, 1)) - a;
  const Vector3 ac = mesh.position(mesh.tets(e, 2)) - a;
  const Vector3 ad = mesh.position(mesh.tets(e, 3)) - a;
  return ab.cross(ac).dot(ad) / 6.0;
}

/// Removes the nodes that belong to no tetrahedron, and what groups have there, keeping the order
/// of the others; returns how many there were. Indices must be in range.
int drop_unused_nodes(TetMesh& mesh);

/// The same body of quadratic tetrahedra: a node in the middle of every edge. The nodes of the
/// linear mesh come first and keep their numbers; the new ones follow in the order in which the
/// elements meet their edges. Groups get the middles of their edges as well.
TetMesh quadratic_mesh(const TetMesh& linear);

}  // namespace irdm::precompute
