#include "precompute/mesh/surface_mesh.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

namespace irdm::precompute {
namespace {

constexpr double kWeldDistance = 1e-6;  // share of the diagonal

// Finds nodes by place: a grid of cells as wide as the distance, so that a near node lies in the
// same cell or in one beside it.
class Welder {
 public:
  explicit Welder(double distance) : distance_(distance) {}

  int number(const Vector3& place) {
    const Cell cell = cell_of(place);
    for (std::int64_t dx = -1; dx <= 1; ++dx) {
      for (std::int64_t dy = -1; dy <= 1; ++dy) {
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto found = cells_.find({cell[0] + dx, cell[1] + dy, cell[2] + dz});
          if (found == cells_.end()) continue;
          for (const int node : found->second) {
            if ((places_[static_cast<std::size_t>(node)] - place).norm() <= distance_) return node;
          }
        }
      }
    }
    const int node = static_cast<int>(places_.size());
    places_.push_back(place);
    cells_[cell].push_back(node);
    return node;
  }

  Points places() const {
    Points nodes(static_cast<Eigen::Index>(places_.size()), 3);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      nodes.row(static_cast<Eigen::Index>(i)) = places_[i].transpose();
    }
    return nodes;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell_of(const Vector3& place) const {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cell[axis] = std::llround(place(static_cast<Eigen::Index>(axis)) / distance_);
    }
    return cell;
  }

  double distance_;
  std::vector<Vector3> places_;
  std::map<Cell, std::vector<int>> cells_;
};

}  // namespace

std::string place_text(const Vector3& place) {
  char text[80];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", place.x(), place.y(), place.z());
  return text;
}

std::string place(const SurfaceMesh& surface, int node) {
  return place_text(surface.nodes.row(node).transpose());
}

double diagonal(const SurfaceMesh& surface) {
  if (surface.triangles.size() == 0) return 0.0;
  // Only nodes that triangles use count: a stray one far away would make all others meet.
  const Points used = surface.nodes(surface.triangles.reshaped<Eigen::RowMajor>(), Eigen::all);
  return (used.colwise().maxCoeff() - used.colwise().minCoeff()).norm();
}

double mean_edge(const SurfaceMesh& surface) {
  double sum = 0.0;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    for (int i = 0; i < 3; ++i) {
      sum += (surface.nodes.row(surface.triangles(t, i)) -
              surface.nodes.row(surface.triangles(t, (i + 1) % 3)))
                 .norm();
    }
  }
  return sum / static_cast<double>(surface.triangles.size());
}

double enclosed_volume(const SurfaceMesh& surface) {
  const Vector3 origin = surface.nodes.colwise().mean().transpose();
  double sum = 0.0;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const auto corner = [&](int i) -> Vector3 {
      return surface.nodes.row(surface.triangles(t, i)).transpose() - origin;
    };
    sum += corner(0).cross(corner(1)).dot(corner(2)) / 6.0;
  }
  return std::abs(sum);
}

SurfaceMesh weld(const SurfaceMesh& surface) {
  Welder welder(std::max(kWeldDistance * diagonal(surface), 1e-300));
  std::vector<int> corners;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    std::array<int, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      const int node = surface.triangles(t, static_cast<Eigen::Index>(i));
      triangle[i] = welder.number(surface.nodes.row(node).transpose());
    }
    const auto [a, b, c] = triangle;
    if (a != b && b != c && c != a) corners.insert(corners.end(), {a, b, c});
  }
  SurfaceMesh welded;
  const Points places = welder.places();
  std::vector<int> number(static_cast<std::size_t>(places.rows()), -1);
  std::vector<int> kept;
  for (int& node : corners) {
    int& renumbered = number[static_cast<std::size_t>(node)];
    if (renumbered < 0) {
      renumbered = static_cast<int>(kept.size());
      kept.push_back(node);
    }
    node = renumbered;
  }
  welded.nodes = places(kept, Eigen::all);
  welded.triangles =
      Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size()) / 3, 3);
  return welded;
}

}  // namespace irdm::precompute
