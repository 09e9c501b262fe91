#include "tests/precompute/meshes.hpp"

#include "precompute/mesh/box_mesh.hpp"
#include "precompute/mesh/tetgen_program.hpp"

namespace irdm::test {

using namespace precompute;

TetMesh box_mesh(const Vector3& size, const std::array<int, 3>& cells) {
  return tetrahedralise(box_surface(size, cells));
}

TetMesh one_tet() {
  TetMesh mesh;
  mesh.nodes.resize(4, 3);
  mesh.nodes << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.tets.resize(1, 4);
  mesh.tets << 0, 1, 2, 3;
  return mesh;
}

TetMesh two_tets() {
  TetMesh mesh = one_tet();
  mesh.nodes.conservativeResize(5, 3);
  mesh.nodes.row(4) << 1, 1, 1;
  mesh.tets.conservativeResize(2, 4);
  mesh.tets.row(1) << 1, 2, 3, 4;
  return mesh;
}

TetMesh together(const TetMesh& a, const TetMesh& b) {
  TetMesh mesh;
  mesh.nodes.resize(a.node_count() + b.node_count(), 3);
  mesh.nodes << a.nodes, b.nodes;
  mesh.tets.resize(a.tet_count() + b.tet_count(), 4);
  mesh.tets << a.tets, b.tets.array() + a.node_count();
  return mesh;
}

}  // namespace irdm::test
