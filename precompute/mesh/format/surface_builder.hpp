#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "precompute/mesh/format/polygon.hpp"
#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {

/// Collects what a surface file lists.
class SurfaceBuilder {
 public:
  void add_node(double x, double y, double z) {
    coordinates_.insert(coordinates_.end(), {x, y, z});
  }

  /// Adds a flat polygon of nodes in range and returns its triangles, as numbers of its corners.
  std::vector<std::array<int, 3>> add_polygon(const std::vector<int>& corners) {
    std::vector<Vector3> places;
    for (const int corner : corners) {
      places.emplace_back(coordinates_.data() + 3 * static_cast<std::size_t>(corner));
    }
    std::vector<std::array<int, 3>> triangles = cut_polygon(places);
    for (const std::array<int, 3>& triangle : triangles) {
      for (const int i : triangle) corners_.push_back(corners[static_cast<std::size_t>(i)]);
    }
    return triangles;
  }

  int node_count() const { return static_cast<int>(coordinates_.size() / 3); }

  SurfaceMesh surface() const {
    const auto rows = [](std::size_t size) { return static_cast<Eigen::Index>(size / 3); };
    return {Eigen::Map<const Points>(coordinates_.data(), rows(coordinates_.size()), 3),
            Eigen::Map<const Triangles>(corners_.data(), rows(corners_.size()), 3)};
  }

 private:
  std::vector<double> coordinates_;
  std::vector<int> corners_;
};

}  // namespace irdm::precompute
