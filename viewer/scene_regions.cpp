#include "viewer/scene_regions.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

namespace irdm::viewer {
namespace {

using Corners = std::array<int, 3>;

/// Of a tetrahedron, outward: the corners of the face opposite to each corner, and in a quadratic
/// one the nodes in the middle between first and second, second and third, third and first.
struct LocalFace {
  Corners corners;
  Corners middles;
};
constexpr std::array<LocalFace, 4> kFaces{{{{1, 2, 3}, {5, 9, 8}},
                                           {{0, 3, 2}, {7, 9, 6}},
                                           {{0, 1, 3}, {4, 8, 7}},
                                           {{0, 2, 1}, {6, 5, 4}}}};
constexpr float kStep = 2.0F;  // of Young's modulus within a region

Corners sorted(Corners corners) {
  std::ranges::sort(corners);
  return corners;
}

/// A face of a tetrahedron.
struct Face {
  Corners corners;  ///< increasing
  int element;
  std::size_t side;  ///< into kFaces
};

Corners nodes_of(const ModelMesh& mesh, int element, const Corners& local) {
  return {mesh.tets(element, local[0]), mesh.tets(element, local[1]), mesh.tets(element, local[2])};
}

// The two faces that tetrahedra have in common stand side by side.
std::vector<Face> faces_of(const ModelMesh& mesh) {
  std::vector<Face> faces;
  for (int e = 0; e < mesh.tets.rows(); ++e) {
    for (std::size_t side = 0; side < kFaces.size(); ++side) {
      faces.push_back({sorted(nodes_of(mesh, e, kFaces[side].corners)), e, side});
    }
  }
  std::ranges::sort(faces, [](const Face& a, const Face& b) {
    return std::pair(a.corners, a.element) < std::pair(b.corners, b.element);
  });
  return faces;
}

/// The tetrahedra behind triangles of the surface.
using Behind = std::map<Corners, int>;

void add_surface_face(const ModelMesh& mesh, const Face& face, Behind& behind) {
  if (mesh.tets.cols() == 4) {
    behind.emplace(face.corners, face.element);
    return;
  }
  const Corners corner = nodes_of(mesh, face.element, kFaces[face.side].corners);
  const Corners middle = nodes_of(mesh, face.element, kFaces[face.side].middles);
  behind.emplace(sorted(middle), face.element);
  for (std::size_t i = 0; i < 3; ++i) {
    behind.emplace(sorted({corner[i], middle[i], middle[(i + 2) % 3]}), face.element);
  }
}

class Materials {
 public:
  explicit Materials(const ElementMaterials& elements) : elements_(elements) {}

  float modulus(int element) const {
    return static_cast<float>(elements_.youngs_modulus[static_cast<std::size_t>(element)]);
  }
  bool differ(int a, int b) const {
    if (region(a) != region(b)) return true;
    const auto [softer, stiffer] = std::minmax({modulus(a), modulus(b)});
    return stiffer > kStep * softer;
  }
  /// Whether a face between them is coloured as a.
  bool prevails(int a, int b) const {
    return std::pair(region(a), modulus(a)) > std::pair(region(b), modulus(b));
  }

 private:
  int region(int element) const { return elements_.region[static_cast<std::size_t>(element)]; }
  const ElementMaterials& elements_;
};

/// Takes faces inside, up to kMaxRegionFaces.
class FaceList {
 public:
  FaceList(const ModelMesh& mesh, SceneRegions& regions) : mesh_(mesh), regions_(regions) {}

  void add(const Face& face, float modulus) {
    if (faces_.size() >= kMaxRegionFaces) regions_.faces_left_out = true;
    if (regions_.faces_left_out) return;
    Corners own{};
    const Corners nodes = nodes_of(mesh_, face.element, kFaces[face.side].corners);
    std::ranges::transform(nodes, own.begin(), [this](int node) { return number_of(node); });
    faces_.push_back(own);
    regions_.face_modulus.push_back(modulus);
  }

  void finish() {
    if (regions_.faces_left_out) {
      regions_.face_modulus.clear();
      return;
    }
    regions_.nodes.resize(static_cast<Eigen::Index>(nodes_.size()), 3);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      regions_.nodes.row(static_cast<Eigen::Index>(i)) = mesh_.nodes.row(nodes_[i]);
    }
    regions_.faces.resize(static_cast<Eigen::Index>(faces_.size()), 3);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      for (std::size_t i = 0; i < 3; ++i) {
        regions_.faces(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(i)) = faces_[f][i];
      }
    }
  }

 private:
  int number_of(int node) {
    const auto [found, added] = numbers_.try_emplace(node, static_cast<int>(nodes_.size()));
    if (added) nodes_.push_back(node);
    return found->second;
  }
  const ModelMesh& mesh_;
  SceneRegions& regions_;
  std::vector<Corners> faces_;
  std::vector<int> nodes_;
  std::map<int, int> numbers_;
};

void widen(Span& span, double value) {
  const auto single = static_cast<float>(value);
  span.lowest = std::min(span.lowest, single);
  span.highest = std::max(span.highest, single);
}

void list_regions(const ElementMaterials& elements, SceneRegions& listed) {
  constexpr Span kNothing{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
  std::map<int, SceneRegion> regions;
  for (std::size_t e = 0; e < elements.region.size(); ++e) {
    const auto number = static_cast<std::uint32_t>(elements.region[e]);
    SceneRegion& region =
        regions.try_emplace(elements.region[e], SceneRegion{number, kNothing, kNothing, kNothing})
            .first->second;
    widen(region.youngs_modulus, elements.youngs_modulus[e]);
    widen(region.poisson_ratio, elements.poisson_ratio[e]);
    widen(region.density, elements.density[e]);
  }
  for (const auto& [number, region] : regions) {
    if (listed.regions.size() < kMaxRegions) listed.regions.push_back(region);
  }
  listed.some_unlisted = regions.size() > kMaxRegions;
}

// NaN where no tetrahedron has the triangle.
std::vector<float> surface_moduli(const ModelMesh& mesh, const Materials& materials,
                                  const Behind& behind) {
  std::vector<float> moduli;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    Corners nodes{};
    for (std::size_t i = 0; i < 3; ++i) {
      const int node = mesh.triangles(t, static_cast<Eigen::Index>(i));
      nodes[i] = mesh.surface_nodes[static_cast<std::size_t>(node)];
    }
    const auto found = behind.find(sorted(nodes));
    moduli.push_back(found == behind.end() ? std::numeric_limits<float>::quiet_NaN()
                                           : materials.modulus(found->second));
  }
  return moduli;
}

}  // namespace

SceneRegions scene_regions(const Model& model) {
  SceneRegions regions;
  if (model.material.elements.empty() || is_rigid(model)) return regions;
  list_regions(model.material.elements, regions);
  const Materials materials(model.material.elements);
  Behind behind;
  FaceList inside(model.mesh, regions);
  const std::vector<Face> faces = faces_of(model.mesh);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const bool shared = i + 1 < faces.size() && faces[i + 1].corners == faces[i].corners;
    if (!shared) {
      add_surface_face(model.mesh, faces[i], behind);
      continue;
    }
    const Face* later = &faces[i];
    const Face* other = &faces[++i];
    if (materials.prevails(other->element, later->element)) std::swap(later, other);
    if (!materials.differ(later->element, other->element)) continue;
    inside.add(*later, materials.modulus(later->element));
  }
  inside.finish();
  regions.surface_modulus = surface_moduli(model.mesh, materials, behind);
  return regions;
}

}  // namespace irdm::viewer
