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

/// A mesh of tetrahedra, all linear or all quadratic. N nodes, E elements. The corners of an
/// element (a, b, c, d) are ordered so that (b-a) x (c-a) points towards d: positive volume. They
/// come first; in a quadratic element the mid-side nodes follow (see kTetEdges). Where these lie
/// beside the middles, edges are curved: an element is what its own shape functions make of its
/// nodes.
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

/// Signed volume of tetrahedron e between its corners [m^3].
inline double signed_volume(const TetMesh& mesh, int e) {
  const Vector3 a = mesh.position(mesh.tets(e, 0));
  const Vector3 ab = mesh.position(mesh.tets(e, 1)) - a;
  const Vector3 ac = mesh.position(mesh.tets(e, 2)) - a;
  const Vector3 ad = mesh.position(mesh.tets(e, 3)) - a;
  return ab.cross(ac).dot(ad) / 6.0;
}

/// Mean of the corners of tetrahedron e [m].
inline Vector3 centroid_of(const TetMesh& mesh, int e) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < 4; ++i) sum += 0.25 * mesh.position(mesh.tets(e, i));
  return sum;
}

/// "the tetrahedron around (0.1, 0.2, 0.3)", for messages: the numbers of a file are not known
/// here.
std::string tetrahedron_text(const TetMesh& mesh, int e);

/// Whether the edges of element e are straight, its mid-side nodes in their middles.
inline bool is_straight(const TetMesh& mesh, int e) {
  for (std::size_t k = 0; mesh.order() == 2 && k < kTetEdges.size(); ++k) {
    const Vector3 a = mesh.position(mesh.tets(e, kTetEdges[k][0]));
    const Vector3 b = mesh.position(mesh.tets(e, kTetEdges[k][1]));
    const Vector3 middle = mesh.position(mesh.tets(e, 4 + static_cast<int>(k)));
    if ((middle - 0.5 * (a + b)).norm() > 1e-9 * (b - a).norm()) return false;
  }
  return true;
}

/// A place in the quadratic element e [m]. @param b its barycentric coordinates
inline Vector3 place(const TetMesh& mesh, int e, const Eigen::Vector4d& b) {
  Vector3 x = Vector3::Zero();
  for (int i = 0; i < 4; ++i) x += b(i) * (2.0 * b(i) - 1.0) * mesh.position(mesh.tets(e, i));
  for (std::size_t k = 0; k < kTetEdges.size(); ++k) {
    const auto& [i, j] = kTetEdges[k];
    x += 4.0 * b(i) * b(j) * mesh.position(mesh.tets(e, 4 + static_cast<int>(k)));
  }
  return x;
}

/// How a place in the quadratic element e moves with the last three barycentric coordinates [m],
/// one a column, while the first keeps their sum. With straight edges: the edges from corner 0.
/// @param b barycentric coordinates of the place
inline Matrix3 jacobian(const TetMesh& mesh, int e, const Eigen::Vector4d& b) {
  Eigen::Matrix<double, 3, 4> along;
  for (int i = 0; i < 4; ++i) along.col(i) = (4.0 * b(i) - 1.0) * mesh.position(mesh.tets(e, i));
  for (std::size_t k = 0; k < kTetEdges.size(); ++k) {
    const auto& [i, j] = kTetEdges[k];
    const Vector3 middle = mesh.position(mesh.tets(e, 4 + static_cast<int>(k)));
    along.col(i) += 4.0 * b(j) * middle;
    along.col(j) += 4.0 * b(i) * middle;
  }
  return along.rightCols<3>().colwise() - along.col(0);
}

/// Removes the nodes that belong to no tetrahedron, and what groups have there, keeping the order
/// of the others; returns how many there were. Indices must be in range.
int drop_unused_nodes(TetMesh& mesh);

/// The same body of quadratic tetrahedra: a node in the middle of every straight edge. The nodes of
/// the linear mesh come first and keep their numbers; the new ones follow in the order in which the
/// elements meet their edges. Groups get the middles of their edges as well.
TetMesh quadratic_mesh(const TetMesh& linear);

/// Eight linear tetrahedra for each quadratic one, at its ten nodes: half the edges, the same
/// nodes. Curved edges become two straight ones. Child k of element e is element 8 e + k. No
/// groups.
TetMesh split_mesh(const TetMesh& quadratic);

}  // namespace irdm::precompute
