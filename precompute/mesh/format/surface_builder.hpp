#pragma once

#include <cstddef>
#include <vector>

#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {

/// Collects what a surface file lists.
class SurfaceBuilder {
 public:
  void add_node(double x, double y, double z) {
    coordinates_.insert(coordinates_.end(), {x, y, z});
  }

  /// A flat convex polygon of nodes in range, cut into triangles from its first corner.
  void add_polygon(const std::vector<int>& corners) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      corners_.insert(corners_.end(), {corners[0], corners[i - 1], corners[i]});
    }
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
