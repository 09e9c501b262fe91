#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "common/geometry.hpp"
#include "common/model/model.hpp"

namespace irdm {

/// Bounding-box tree over the triangles of the surface at rest. Built once; queries are real-time
/// safe and read only, so that several threads may ask at the same time.
class SurfaceTree {
 public:
  explicit SurfaceTree(const ModelMesh& mesh);

  /// The triangle of the rest surface nearest to p (B); ties go to the lowest number.
  int closest_triangle(const Vector3& p) const noexcept;

  /// Triangles whose bounding box at rest overlaps a box, as many as `found` has room for; returns
  /// how many.
  int overlapping(const Eigen::AlignedBox3d& box, std::span<int> found) const noexcept;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0;  ///< leaf: first entry in order_; inner node: number of the right child
    int count = 0;  ///< leaf: number of triangles; inner node: 0. The left child follows its parent
  };
  void build(int begin, int end);

  std::vector<std::array<Vector3, 3>> triangles_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace irdm
