#include "precompute/mesh/tet_mesh.hpp"

#include <algorithm>
#include <array>
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

namespace {

// The octahedron in the middle of a split tetrahedron: two opposite nodes, and the four others in
// the order in which they surround them, so that the four tetrahedra have positive volumes.
struct Octahedron {
  std::array<int, 2> diagonal;
  std::array<int, 4> ring;
};
constexpr std::array<Octahedron, 3> kOctahedra{
    {{{4, 9}, {5, 6, 7, 8}}, {{5, 7}, {6, 4, 8, 9}}, {{6, 8}, {4, 5, 9, 7}}}};
constexpr std::array<std::array<int, 4>, 4> kCornerChildren{
    {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}}};

}  // namespace

TetMesh split_mesh(const TetMesh& quadratic) {
  TetMesh mesh;
  mesh.nodes = quadratic.nodes;
  mesh.tets.resize(8 * quadratic.tets.rows(), 4);
  Eigen::Index child = 0;
  for (int e = 0; e < quadratic.tet_count(); ++e) {
    const auto node = [&](int local) { return quadratic.tets(e, local); };
    const auto add = [&](int a, int b, int c, int d) {
      mesh.tets.row(child++) << node(a), node(b), node(c), node(d);
    };
    for (const auto& [a, b, c, d] : kCornerChildren) add(a, b, c, d);
    const auto length = [&](const Octahedron& o) {
      return (mesh.position(node(o.diagonal[0])) - mesh.position(node(o.diagonal[1]))).norm();
    };
    const Octahedron& shortest = *std::min_element(
        kOctahedra.begin(), kOctahedra.end(),
        [&](const Octahedron& a, const Octahedron& b) { return length(a) < length(b); });
    for (std::size_t k = 0; k < 4; ++k) {
      add(shortest.diagonal[0], shortest.diagonal[1], shortest.ring[k], shortest.ring[(k + 1) % 4]);
    }
  }
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
