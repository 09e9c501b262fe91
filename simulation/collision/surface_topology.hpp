#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/model/model.hpp"

namespace irdm {

/// Which triangles meet at a node. Built once, read only.
class SurfaceTopology {
 public:
  explicit SurfaceTopology(const ModelMesh& mesh);

  std::span<const int> triangles_around(int node) const noexcept {
    const auto begin = static_cast<std::size_t>(offsets_[static_cast<std::size_t>(node)]);
    const auto end = static_cast<std::size_t>(offsets_[static_cast<std::size_t>(node) + 1]);
    return {triangles_.data() + begin, end - begin};
  }
  const std::array<int, 3>& corners(int triangle) const noexcept {
    return corners_[static_cast<std::size_t>(triangle)];
  }

 private:
  std::vector<std::array<int, 3>> corners_;
  std::vector<int> offsets_;
  std::vector<int> triangles_;
};

}  // namespace irdm
