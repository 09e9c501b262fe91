#pragma once

#include <array>
#include <optional>

#include "common/geometry.hpp"

namespace irdm {

using TriangleCorners = std::array<Vector3, 3>;
using Barycentric = std::array<double, 3>;

/// Barycentric weights (>= 0, sum 1) of the point of a triangle nearest to p. On an edge the weight
/// of the far corner is exactly 0, at a corner both others are. A degenerate triangle counts as its
/// edges.
Barycentric closest_point(const TriangleCorners& triangle, const Vector3& p) noexcept;

/// The point with these weights.
Vector3 at(const TriangleCorners& triangle, const Barycentric& weights) noexcept;

/// Normal with the length of twice the area, by the right-hand rule.
Vector3 area_normal(const TriangleCorners& triangle) noexcept;

/// Where the segment from `from` to `to` enters the triangle from the side of its normal.
struct Crossing {
  double fraction = 0.0;  ///< of the way from `from` to `to`, in [0, 1]
  Barycentric weights{};
};
std::optional<Crossing> crossing(const TriangleCorners& triangle, const Vector3& from,
                                 const Vector3& to) noexcept;

}  // namespace irdm
