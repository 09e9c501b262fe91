#include "precompute/display/corner_normals.hpp"

#include <cmath>
#include <map>
#include <vector>

namespace irdm::precompute {
namespace {

using Edge = std::pair<int, int>;

Edge edge_of(const Triangles& triangles, Eigen::Index t, int corner) {
  return std::minmax(triangles(t, corner), triangles(t, (corner + 1) % 3));
}

std::map<Edge, std::vector<int>> triangles_of_edges(const Triangles& triangles) {
  std::map<Edge, std::vector<int>> edges;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (int i = 0; i < 3; ++i) edges[edge_of(triangles, t, i)].push_back(static_cast<int>(t));
  }
  return edges;
}

// Twice the area long.
Points area_normals(const SurfaceMesh& surface) {
  Points normals(surface.triangles.rows(), 3);
  for (Eigen::Index t = 0; t < normals.rows(); ++t) {
    const auto corner = [&](int i) -> Vector3 {
      return surface.nodes.row(surface.triangles(t, i)).transpose();
    };
    normals.row(t) = (corner(1) - corner(0)).cross(corner(2) - corner(0)).transpose();
  }
  return normals;
}

// What a triangle adds to the normal at one of its corners: sides' cross product over their
// squares, which is exact on a sphere. (Max: Weights for computing vertex normals from facet
// normals, Journal of Graphics Tools 4, 1999.)
Vector3 at_corner(const SurfaceMesh& surface, Eigen::Index t, int i) {
  const auto to = [&](int other) -> Vector3 {
    return (surface.nodes.row(surface.triangles(t, (i + other) % 3)) -
            surface.nodes.row(surface.triangles(t, i)))
        .transpose();
  };
  const Vector3 a = to(1), b = to(2);
  const double squares = a.squaredNorm() * b.squaredNorm();
  return squares > 0.0 ? Vector3(a.cross(b) / squares) : Vector3::Zero();
}

bool is_sharp(const std::vector<int>& triangles, const Points& normals, double crease_angle) {
  if (triangles.size() != 2) return true;
  const Vector3 a = normals.row(triangles[0]);
  const Vector3 b = normals.row(triangles[1]);
  const double lengths = a.norm() * b.norm();
  return lengths > 0.0 && a.dot(b) < std::cos(crease_angle) * lengths;
}

// Without lines that lead to an end: what is left are closed ones, and lines between those.
void prune(std::set<Edge>& edges) {
  std::map<int, std::set<Edge>> at;
  for (const Edge& edge : edges) {
    at[edge.first].insert(edge);
    at[edge.second].insert(edge);
  }
  std::vector<int> ends;
  for (const auto& [node, list] : at) ends.push_back(node);
  while (!ends.empty()) {
    const std::set<Edge>& here = at[ends.back()];
    ends.pop_back();
    if (here.size() != 1) continue;
    const Edge edge = *here.begin();
    edges.erase(edge);
    for (const int node : {edge.first, edge.second}) {
      at[node].erase(edge);
      ends.push_back(node);
    }
  }
}

// Corners (3 triangle + i) that share a normal, as a forest of parents.
class SharedNormals {
 public:
  explicit SharedNormals(std::size_t corners) : parent_(corners) {
    for (std::size_t i = 0; i < corners; ++i) parent_[i] = i;
  }
  std::size_t root(std::size_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }
  void join(std::size_t a, std::size_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::size_t> parent_;
};

std::size_t corner_at(const Triangles& triangles, int t, int node) {
  std::size_t i = 0;
  while (triangles(t, static_cast<Eigen::Index>(i)) != node) ++i;
  return 3 * static_cast<std::size_t>(t) + i;
}

}  // namespace

Shading smooth_shading(const SurfaceMesh& surface, double crease_angle) {
  const Triangles& triangles = surface.triangles;
  const Points areas = area_normals(surface);
  const auto edges = triangles_of_edges(triangles);
  Shading shading;
  for (const auto& [edge, sides] : edges) {
    if (is_sharp(sides, areas, crease_angle)) shading.creases.insert(edge);
  }
  prune(shading.creases);

  const auto corners = static_cast<std::size_t>(triangles.size());
  SharedNormals shared(corners);
  for (const auto& [edge, sides] : edges) {
    if (sides.size() != 2 || shading.creases.contains(edge)) continue;
    for (const int node : {edge.first, edge.second}) {
      shared.join(corner_at(triangles, sides[0], node), corner_at(triangles, sides[1], node));
    }
  }
  Points sums = Points::Zero(static_cast<Eigen::Index>(corners), 3);
  for (std::size_t c = 0; c < corners; ++c) {
    sums.row(static_cast<Eigen::Index>(shared.root(c))) +=
        at_corner(surface, static_cast<Eigen::Index>(c / 3), static_cast<int>(c % 3)).transpose();
  }
  shading.normals.resize(sums.rows(), 3);
  for (std::size_t c = 0; c < corners; ++c) {
    const Vector3 sum = sums.row(static_cast<Eigen::Index>(shared.root(c)));
    const Vector3 own = areas.row(static_cast<Eigen::Index>(c / 3));
    const Vector3 normal = sum.norm() > 0.0 ? sum : own;
    shading.normals.row(static_cast<Eigen::Index>(c)) =
        (normal.norm() > 0.0 ? normal.normalized() : Vector3::UnitX().eval()).transpose();
  }
  return shading;
}

}  // namespace irdm::precompute
