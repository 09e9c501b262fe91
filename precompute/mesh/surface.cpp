#include "precompute/mesh/surface.hpp"

#include <algorithm>
#include <string>

#include "common/error.hpp"
#include "precompute/mesh/faces.hpp"

namespace irdm::precompute {
namespace {

// Two elements of positive volume see their common face the same way round only when they overlap.
bool same_side(const TetMesh& mesh, const TetFace& a, const TetFace& b) {
  const auto nodes = face_nodes(mesh, a);
  auto other = face_nodes(mesh, b);
  std::rotate(other.begin(), std::find(other.begin(), other.end(), nodes[0]), other.end());
  return other == nodes;
}

}  // namespace

Triangles boundary_faces(const TetMesh& mesh, const std::string& name) {
  std::vector<TetFace> boundary;
  for (const auto& [nodes, owners] : faces_by_nodes(mesh)) {
    if (owners.size() > 2) {
      throw Error(name,
                  "one face belongs to " + std::to_string(owners.size()) + " tetrahedra (element " +
                      std::to_string(owners.back().tet + 1) + ")",
                  "remove duplicate or overlapping elements");
    }
    if (owners.size() == 1) boundary.push_back(owners.front());
    if (owners.size() == 2 && same_side(mesh, owners[0], owners[1])) {
      throw Error(name,
                  "elements " + std::to_string(owners[0].tet + 1) + " and " +
                      std::to_string(owners[1].tet + 1) + " lie on the same side of a common face",
                  "remove duplicate or overlapping elements");
    }
  }
  std::sort(boundary.begin(), boundary.end(), [](const TetFace& a, const TetFace& b) {
    return std::pair(a.tet, a.face) < std::pair(b.tet, b.face);
  });
  Triangles triangles(static_cast<Eigen::Index>(boundary.size()), 3);
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const auto nodes = face_nodes(mesh, boundary[i]);
    triangles.row(static_cast<Eigen::Index>(i)) << nodes[0], nodes[1], nodes[2];
  }
  return triangles;
}

Surface extract_surface(const TetMesh& mesh, const std::string& name) {
  Surface surface;
  surface.triangles = boundary_faces(mesh, name);
  std::vector<int> number(static_cast<std::size_t>(mesh.node_count()), -1);
  const auto at = [&](int node) -> int& { return number[static_cast<std::size_t>(node)]; };
  for (Eigen::Index i = 0; i < surface.triangles.size(); ++i) at(surface.triangles.data()[i]) = 0;
  for (int node = 0; node < mesh.node_count(); ++node) {
    if (at(node) < 0) continue;
    at(node) = static_cast<int>(surface.nodes.size());
    surface.nodes.push_back(node);
  }
  for (Eigen::Index i = 0; i < surface.triangles.size(); ++i) {
    surface.triangles.data()[i] = at(surface.triangles.data()[i]);
  }
  return surface;
}

}  // namespace irdm::precompute
