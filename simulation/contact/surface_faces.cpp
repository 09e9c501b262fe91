#include "simulation/contact/surface_faces.hpp"

#include <algorithm>
#include <cstddef>
#include <map>

namespace irdm {
namespace {

// For each face of a tetrahedron the local numbers of its corners and of its mid-side nodes, in the
// order of VTK_QUADRATIC_TETRA.
constexpr std::array<std::array<int, 6>, 4> kFaces{
    {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {2, 0, 3, 6, 7, 9}}};

using Key = std::array<int, 3>;

Key key_of(int a, int b, int c) {
  Key key{a, b, c};
  std::sort(key.begin(), key.end());
  return key;
}

class FaceFinder {
 public:
  explicit FaceFinder(const ModelMesh& mesh)
      : mesh_(mesh),
        on_surface_(static_cast<std::size_t>(mesh.nodes.rows()), -1),
        taken_(static_cast<std::size_t>(mesh.triangles.rows()), false) {
    for (int i = 0; i < mesh.surface_node_count(); ++i) {
      on_surface_[static_cast<std::size_t>(mesh.surface_nodes[static_cast<std::size_t>(i)])] = i;
    }
    for (int t = 0; t < static_cast<int>(mesh.triangles.rows()); ++t) {
      triangle_.emplace(key_of(mesh.triangles(t, 0), mesh.triangles(t, 1), mesh.triangles(t, 2)),
                        t);
    }
  }

  std::vector<SurfaceFace> find() {
    for (int e = 0; e < static_cast<int>(mesh_.tets.rows()); ++e) {
      for (const std::array<int, 6>& local : kFaces) add(e, local);
    }
    for (int t = 0; t < static_cast<int>(mesh_.triangles.rows()); ++t) {
      if (taken_[static_cast<std::size_t>(t)]) continue;
      SurfaceFace face;
      for (int i = 0; i < 3; ++i) face.nodes[static_cast<std::size_t>(i)] = mesh_.triangles(t, i);
      face.triangles[0] = t;
      faces_.push_back(face);
    }
    return std::move(faces_);
  }

 private:
  // Returns -1 if the surface has no such triangle.
  int triangle_of(int a, int b, int c) const {
    const auto found = triangle_.find(key_of(a, b, c));
    return found == triangle_.end() ? -1 : found->second;
  }

  void add(int element, const std::array<int, 6>& local) {
    SurfaceFace face;
    face.element = element;
    face.node_count = mesh_.tets.cols() == 10 ? 6 : 3;
    for (int i = 0; i < face.node_count; ++i) {
      const auto index = static_cast<std::size_t>(i);
      const int node = mesh_.tets(element, local[index]);
      face.nodes[index] = on_surface_[static_cast<std::size_t>(node)];
      if (face.nodes[index] < 0) return;
    }
    if (face.node_count == 3) {
      face.triangles[0] = triangle_of(face.nodes[0], face.nodes[1], face.nodes[2]);
    } else {
      const auto& [a, b, c, ab, bc, ca] = face.nodes;
      face.triangles = {triangle_of(ab, bc, ca), triangle_of(a, ab, ca), triangle_of(b, bc, ab),
                        triangle_of(c, ca, bc)};
    }
    const std::size_t count = face.node_count == 3 ? 1 : 4;
    for (std::size_t i = 0; i < count; ++i) {
      if (face.triangles[i] < 0) return;
    }
    turn_outward(face);
    for (std::size_t i = 0; i < count; ++i) {
      taken_[static_cast<std::size_t>(face.triangles[i])] = true;
    }
    faces_.push_back(face);
  }

  // Orders the corners as the middle triangle does, whose normal points outward.
  void turn_outward(SurfaceFace& face) const {
    const bool corners = face.node_count == 3;
    const int first = face.nodes[corners ? 0 : 3];
    const int second = face.nodes[corners ? 1 : 4];
    const int t = face.triangles[0];
    for (int i = 0; i < 3; ++i) {
      if (mesh_.triangles(t, i) != first) continue;
      if (mesh_.triangles(t, (i + 1) % 3) == second) return;
    }
    std::swap(face.nodes[1], face.nodes[2]);
    std::swap(face.nodes[3], face.nodes[5]);
    std::swap(face.triangles[2], face.triangles[3]);
  }

  const ModelMesh& mesh_;
  std::vector<int> on_surface_;  ///< surface number of each node, -1 for an interior node
  std::vector<bool> taken_;      ///< whether each triangle already belongs to a face
  std::map<Key, int> triangle_;
  std::vector<SurfaceFace> faces_;
};

}  // namespace

std::array<double, 6> SurfaceFace::weights(const std::array<double, 3>& at) const noexcept {
  const auto [a, b, c] = at;
  if (node_count == 3) return {a, b, c, 0.0, 0.0, 0.0};
  return {a * (2.0 * a - 1.0), b * (2.0 * b - 1.0), c * (2.0 * c - 1.0),
          4.0 * a * b,         4.0 * b * c,         4.0 * c * a};
}

std::vector<SurfaceFace> surface_faces(const ModelMesh& mesh) {
  return FaceFinder(mesh).find();
}

}  // namespace irdm
