#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry.hpp"
#include "common/model/model.hpp"

namespace irdm {

using TriangleCorners = std::array<Vector3, 3>;
using Barycentric = std::array<double, 3>;

/// Barycentric weights (>= 0, sum 1) of the point of a triangle nearest to p. On an edge the weight
/// of the far corner is exactly 0, at a corner both others are. A degenerate triangle counts as its
/// edges.
Barycentric closest_point(const TriangleCorners& triangle, const Vector3& p) noexcept;

/// What the square of p's distance from a triangle is not below, by its bounding box [m^2].
double least_distance2(const TriangleCorners& triangle, const Vector3& p) noexcept;

/// The point with these weights.
Vector3 at(const TriangleCorners& triangle, const Barycentric& weights) noexcept;

/// Normal with the length of twice the area, by the right-hand rule.
Vector3 area_normal(const TriangleCorners& triangle) noexcept;

/// Where the segment from `from` to `to` enters the triangle from the side of its normal.
/// @param slack that weights may be below 0, so that no way passes between two triangles
struct Crossing {
  double fraction = 0.0;  ///< of the way from `from` to `to`, in [0, 1]
  Barycentric weights{};
};
std::optional<Crossing> crossing(const TriangleCorners& triangle, const Vector3& from,
                                 const Vector3& to, double slack = 0.0) noexcept;

/// Bounding-box tree over the triangles of the surface at rest. Built once; queries are real-time
/// safe and read only, so that several threads may ask at the same time.
class SurfaceTree {
 public:
  explicit SurfaceTree(const ModelMesh& mesh);

  /// The triangle of the rest surface nearest to p (B); ties go to the lowest number.
  /// @param guess the search is short when this triangle is near; what is found is the same
  int closest_triangle(const Vector3& p, int guess = 0) const noexcept;

  /// Triangles whose bounding box at rest overlaps a box, as many as `found` has room for; returns
  /// how many.
  int overlapping(const Eigen::AlignedBox3d& box, std::span<int> found) const noexcept;

  /// Where a way first crosses a triangle of the rest surface from outside.
  struct Entry {
    int triangle = 0;
    double fraction = 0.0;  ///< of the way, in [0, 1]
  };
  std::optional<Entry> first_entry(const Vector3& from, const Vector3& to) const noexcept;

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
