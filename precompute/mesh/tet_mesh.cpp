#include "precompute/mesh/tet_mesh.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {
namespace {

using Edge = std::pair<int, int>;  // the smaller node first

void add_middles(MeshGroup& group, const std::map<Edge, int>& middles) {
  for (std::vector<int>& nodes : group) {
    const std::size_t corners = nodes.size();
    for (std::size_t i = 0; i < corners; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto found = middles.find(std::minmax(nodes[i], nodes[j]));
        if (found != middles.end()) nodes.push_back(found->second);
      }
    }
  }
}

}  // namespace

std::string tetrahedron_text(const TetMesh& mesh, int e) {
  return "the tetrahedron around " + place_text(centroid_of(mesh, e));
}

TetMesh quadratic_mesh(const TetMesh& linear) {
  std::map<Edge, int> middles;
  std::vector<Edge> edges;
  const auto middle = [&](int a, int b) {
    const Edge edge = std::minmax(a, b);
    const int next = linear.node_count() + static_cast<int>(edges.size());
    const auto [place, is_new] = middles.try_emplace(edge, next);
    if (is_new) edges.push_back(edge);
    return place->second;
  };

  TetMesh mesh;
  mesh.tets.resize(linear.tets.rows(), 10);
  mesh.tets.leftCols<4>() = linear.tets;
  for (int e = 0; e < linear.tet_count(); ++e) {
    int node = 4;
    for (const auto& [i, j] : kTetEdges) {
      mesh.tets(e, node++) = middle(linear.tets(e, i), linear.tets(e, j));
    }
  }
  mesh.nodes.resize(linear.nodes.rows() + static_cast<Eigen::Index>(edges.size()), 3);
  mesh.nodes.topRows(linear.nodes.rows()) = linear.nodes;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& [a, b] = edges[i];
    mesh.nodes.row(linear.nodes.rows() + static_cast<Eigen::Index>(i)) =
        0.5 * (linear.nodes.row(a) + linear.nodes.row(b));
  }
  mesh.groups = linear.groups;
  for (auto& [name, group] : mesh.groups) add_middles(group, middles);
  return mesh;
}

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
