#include "precompute/mesh/tet_mesh.hpp"

#include <algorithm>

namespace irdm::precompute {

int drop_unused_nodes(TetMesh& mesh) {
  std::vector<int> new_number(static_cast<std::size_t>(mesh.node_count()), -1);
  const auto number = [&](int node) -> int& { return new_number[static_cast<std::size_t>(node)]; };
  for (Eigen::Index i = 0; i < mesh.tets.size(); ++i) number(mesh.tets.data()[i]) = 0;
  int kept = 0;
  for (int node = 0; node < mesh.node_count(); ++node) {
    if (number(node) < 0) continue;
    mesh.nodes.row(kept) = mesh.nodes.row(node).eval();
    number(node) = kept++;
  }
  const int dropped = mesh.node_count() - kept;
  mesh.nodes.conservativeResize(kept, 3);
  for (Eigen::Index i = 0; i < mesh.tets.size(); ++i) {
    mesh.tets.data()[i] = number(mesh.tets.data()[i]);
  }
  for (auto& [name, group] : mesh.groups) {
    std::erase_if(group, [&](const std::vector<int>& nodes) {
      return std::any_of(nodes.begin(), nodes.end(), [&](int node) { return number(node) < 0; });
    });
    for (std::vector<int>& nodes : group) {
      for (int& node : nodes) node = number(node);
    }
  }
  return dropped;
}

}  // namespace irdm::precompute
