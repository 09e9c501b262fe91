#pragma once

#include "common/geometry.hpp"
#include "common/model/model.hpp"

namespace irdm::precompute {

/// A mesh of linear tetrahedra as it was generated or read. N nodes, E elements. The corners of an
/// element (a, b, c, d) are ordered so that (b-a) x (c-a) points towards d: positive volume.
struct TetMesh {
  Points nodes;         ///< (N, 3) [m], coordinates of the input
  RowMatrix<int> tets;  ///< (E, 4), into nodes

  int node_count() const { return static_cast<int>(nodes.rows()); }
  int tet_count() const { return static_cast<int>(tets.rows()); }
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

/// Removes the nodes that belong to no tetrahedron, keeping the order of the others; returns how
/// many there were. Indices must be in range.
int drop_unused_nodes(TetMesh& mesh);

}  // namespace irdm::precompute
