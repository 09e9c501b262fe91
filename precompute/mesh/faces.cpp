#include "precompute/mesh/faces.hpp"

#include <algorithm>

namespace irdm::precompute {
namespace {

// Local number of the node between two corners of a quadratic tetrahedron.
int mid_node(int a, int b) {
  for (std::size_t k = 0; k < kTetEdges.size(); ++k) {
    const auto& [i, j] = kTetEdges[k];
    if ((i == a && j == b) || (i == b && j == a)) return 4 + static_cast<int>(k);
  }
  return -1;
}

}  // namespace

std::vector<std::array<int, 3>> face_triangles(const TetMesh& mesh, const TetFace& f) {
  if (mesh.order() == 1) return {face_nodes(mesh, f)};
  const auto& [a, b, c] = kTetFaces[static_cast<std::size_t>(f.face)];
  const auto node = [&](int local) { return mesh.tets(f.tet, local); };
  const int ab = node(mid_node(a, b));
  const int bc = node(mid_node(b, c));
  const int ca = node(mid_node(c, a));
  return {{node(a), ab, ca}, {node(b), bc, ab}, {node(c), ca, bc}, {ab, bc, ca}};
}

std::map<std::array<int, 3>, std::vector<TetFace>> faces_by_nodes(const TetMesh& mesh) {
  std::map<std::array<int, 3>, std::vector<TetFace>> faces;
  for (int e = 0; e < mesh.tet_count(); ++e) {
    for (int f = 0; f < 4; ++f) {
      std::array<int, 3> key = face_nodes(mesh, {e, f});
      std::sort(key.begin(), key.end());
      faces[key].push_back({e, f});
    }
  }
  return faces;
}

}  // namespace irdm::precompute
