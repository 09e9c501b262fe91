#include "precompute/mesh/surface.hpp"

#include <algorithm>
#include <string>

#include "common/error.hpp"

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

namespace {

// Two elements of positive volume see their common face the same way round only when they overlap.
bool same_side(const TetMesh& mesh, const TetFace& a, const TetFace& b) {
  const auto nodes = face_nodes(mesh, a);
  auto other = face_nodes(mesh, b);
  std::rotate(other.begin(), std::find(other.begin(), other.end(), nodes[0]), other.end());
  return other == nodes;
}

// Faces of one tetrahedron only, in the order of the elements.
std::vector<TetFace> lone_faces(const TetMesh& mesh, const std::string& name) {
  std::vector<TetFace> boundary;
  for (const auto& [nodes, owners] : faces_by_nodes(mesh)) {
    if (owners.size() > 2) {
      throw Error(name,
                  "one face belongs to " + std::to_string(owners.size()) + " tetrahedra, " +
                      tetrahedron_text(mesh, owners.back().tet) + " among them",
                  "remove duplicate or overlapping elements");
    }
    if (owners.size() == 1) boundary.push_back(owners.front());
    if (owners.size() == 2 && same_side(mesh, owners[0], owners[1])) {
      throw Error(name,
                  tetrahedron_text(mesh, owners[0].tet) + " and " +
                      tetrahedron_text(mesh, owners[1].tet) +
                      " lie on the same side of a common face",
                  "remove duplicate or overlapping elements");
    }
  }
  std::sort(boundary.begin(), boundary.end(), [](const TetFace& a, const TetFace& b) {
    return std::pair(a.tet, a.face) < std::pair(b.tet, b.face);
  });
  return boundary;
}

Triangles as_matrix(const std::vector<std::array<int, 3>>& triangles) {
  Triangles matrix(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    matrix.row(static_cast<Eigen::Index>(i)) << a, b, c;
  }
  return matrix;
}

}  // namespace

Triangles boundary_faces(const TetMesh& mesh, const std::string& name) {
  std::vector<std::array<int, 3>> triangles;
  for (const TetFace& face : lone_faces(mesh, name)) triangles.push_back(face_nodes(mesh, face));
  return as_matrix(triangles);
}

Surface extract_surface(const TetMesh& mesh, const std::string& name) {
  Surface surface;
  std::vector<std::array<int, 3>> triangles;
  for (const TetFace& face : lone_faces(mesh, name)) {
    for (const auto& triangle : face_triangles(mesh, face)) triangles.push_back(triangle);
  }
  surface.triangles = as_matrix(triangles);
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
