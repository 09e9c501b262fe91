#include "precompute/mesh/surface_check.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "common/error.hpp"

namespace irdm::precompute {
namespace {

using Edge = std::pair<int, int>;                     // the lower node first
using EdgeOwners = std::map<Edge, std::vector<int>>;  // triangles at each edge

std::string place(const SurfaceMesh& surface, const Edge& edge) {
  return "from " + place(surface, edge.first) + " to " + place(surface, edge.second);
}

EdgeOwners edge_owners(const SurfaceMesh& surface) {
  EdgeOwners owners;
  for (int t = 0; t < surface.triangles.rows(); ++t) {
    for (int i = 0; i < 3; ++i) {
      owners[std::minmax({surface.triangles(t, i), surface.triangles(t, (i + 1) % 3)})].push_back(
          t);
    }
  }
  return owners;
}

std::string edges(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " edge" : " edges");
}

void check_edges(const SurfaceMesh& surface, const EdgeOwners& owners, const std::string& name) {
  std::vector<Edge> open;
  std::vector<Edge> crowded;
  for (const auto& [edge, triangles] : owners) {
    if (triangles.size() == 1) open.push_back(edge);
    if (triangles.size() > 2) crowded.push_back(edge);
  }
  if (!open.empty()) {
    throw Error(name,
                "the surface is open at " + edges(open.size()) + ", for instance " +
                    place(surface, open.front()),
                "close the hole there with the program that made it");
  }
  if (!crowded.empty()) {
    throw Error(name,
                "the surface is not manifold: more than two triangles meet at " +
                    edges(crowded.size()) + ", for instance " + place(surface, crowded.front()),
                "remove double triangles and inner walls there");
  }
}

// Whether triangle t runs along the edge from `a` to `b`.
bool runs(const SurfaceMesh& surface, int t, int a, int b) {
  for (int i = 0; i < 3; ++i) {
    if (surface.triangles(t, i) == a && surface.triangles(t, (i + 1) % 3) == b) return true;
  }
  return false;
}

// Turns the triangles that can be reached from the first one as that one is; which these are.
std::vector<bool> turn_alike(SurfaceMesh& surface, const EdgeOwners& owners) {
  std::vector<bool> reached(static_cast<std::size_t>(surface.triangles.rows()), false);
  reached.front() = true;
  for (std::vector<int> pending{0}; !pending.empty();) {
    const int t = pending.back();
    pending.pop_back();
    for (int i = 0; i < 3; ++i) {
      const int a = surface.triangles(t, i);
      const int b = surface.triangles(t, (i + 1) % 3);
      for (const int other : owners.at(std::minmax(a, b))) {
        if (reached[static_cast<std::size_t>(other)]) continue;
        reached[static_cast<std::size_t>(other)] = true;
        // Neighbours run along their common edge in opposite directions.
        if (runs(surface, other, a, b)) {
          std::swap(surface.triangles(other, 1), surface.triangles(other, 2));
        }
        pending.push_back(other);
      }
    }
  }
  return reached;
}

}  // namespace

SurfaceMesh checked_surface(const SurfaceMesh& surface, const std::string& name) {
  if (surface.triangles.rows() < 4) {
    throw Error(name, "has " + std::to_string(surface.triangles.rows()) + " triangles",
                "give a closed surface of triangles");
  }
  const EdgeOwners owners = edge_owners(surface);
  check_edges(surface, owners, name);
  SurfaceMesh turned = surface;
  const std::vector<bool> reached = turn_alike(turned, owners);
  const auto other = std::find(reached.begin(), reached.end(), false);
  if (other != reached.end()) {
    const auto t = static_cast<Eigen::Index>(other - reached.begin());
    throw Error(
        name,
        "the surface is in more than one piece: " + place(surface, surface.triangles(0, 0)) +
            " and " + place(surface, surface.triangles(t, 0)) + " are not connected",
        "keep one closed surface; a cavity inside it needs a tetrahedral mesh");
  }
  return turned;
}

}  // namespace irdm::precompute
