#include "precompute/mesh/box_mesh.hpp"

#include <map>
#include <vector>

namespace irdm::precompute {
namespace {

using GridPoint = std::array<int, 3>;

class BoxBuilder {
 public:
  BoxBuilder(const Vector3& size, const std::array<int, 3>& cells) : size_(size), cells_(cells) {}

  SurfaceMesh build() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      add_face(axis, 0);
      add_face(axis, cells_[axis]);
    }
    SurfaceMesh surface;
    surface.nodes.resize(static_cast<Eigen::Index>(points_.size()), 3);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      surface.nodes.row(static_cast<Eigen::Index>(i)) = coordinates(points_[i]).transpose();
    }
    surface.triangles = Eigen::Map<const Triangles>(
        corners_.data(), static_cast<Eigen::Index>(corners_.size()) / 3, 3);
    return surface;
  }

 private:
  Vector3 coordinates(const GridPoint& p) const {
    Vector3 x;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      x(k) = size_(k) * p[axis] / cells_[axis];
    }
    return x;
  }

  int number(const GridPoint& p) {
    const auto [place, is_new] = numbers_.try_emplace(p, static_cast<int>(points_.size()));
    if (is_new) points_.push_back(p);
    return place->second;
  }

  void add_triangle(int a, int b, int c) { corners_.insert(corners_.end(), {a, b, c}); }

  // The face across `axis` at grid level `level`; u, v and the axis are right-handed.
  void add_face(std::size_t axis, int level) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (int i = 0; i < cells_[u]; ++i) {
      for (int j = 0; j < cells_[v]; ++j) {
        const auto corner = [&](int di, int dj) {
          GridPoint p{};
          p[axis] = level;
          p[u] = i + di;
          p[v] = j + dj;
          return number(p);
        };
        std::array<int, 4> quad{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
        if (level == 0) std::swap(quad[1], quad[3]);
        const bool even = (i + j) % 2 == 0;
        add_triangle(quad[0], quad[1], even ? quad[2] : quad[3]);
        add_triangle(even ? quad[0] : quad[1], quad[2], quad[3]);
      }
    }
  }

  Vector3 size_;
  std::array<int, 3> cells_;
  std::map<GridPoint, int> numbers_;
  std::vector<GridPoint> points_;
  std::vector<int> corners_;
};

}  // namespace

SurfaceMesh box_surface(const Vector3& size, const std::array<int, 3>& cells) {
  return BoxBuilder(size, cells).build();
}

}  // namespace irdm::precompute
