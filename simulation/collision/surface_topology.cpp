#include "simulation/collision/surface_topology.hpp"

namespace irdm {

SurfaceTopology::SurfaceTopology(const ModelMesh& mesh) {
  const auto nodes = static_cast<std::size_t>(mesh.surface_node_count());
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    corners_.push_back({mesh.triangles(t, 0), mesh.triangles(t, 1), mesh.triangles(t, 2)});
  }
  offsets_.assign(nodes + 1, 0);
  for (const auto& triangle : corners_) {
    for (const int node : triangle) ++offsets_[static_cast<std::size_t>(node) + 1];
  }
  for (std::size_t i = 0; i < nodes; ++i) offsets_[i + 1] += offsets_[i];
  triangles_.resize(3 * corners_.size());
  std::vector<int> next(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t t = 0; t < corners_.size(); ++t) {
    for (const int node : corners_[t]) {
      triangles_[static_cast<std::size_t>(next[static_cast<std::size_t>(node)]++)] =
          static_cast<int>(t);
    }
  }
}

}  // namespace irdm
