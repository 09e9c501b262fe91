#include "precompute/mesh/faces.hpp"

#include <algorithm>

namespace irdm::precompute {

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
