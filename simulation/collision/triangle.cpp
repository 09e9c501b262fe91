#include "simulation/collision/triangle.hpp"

#include <algorithm>

namespace irdm {
namespace {

// Nearest point of the edge from corner i to corner j, as weights.
Barycentric closest_on_edge(const TriangleCorners& triangle, std::size_t i, std::size_t j,
                            const Vector3& p) noexcept {
  const Vector3 edge = triangle[j] - triangle[i];
  const double length2 = edge.squaredNorm();
  const double along =
      length2 > 0 ? std::clamp((p - triangle[i]).dot(edge) / length2, 0.0, 1.0) : 0.0;
  Barycentric weights{};
  weights[i] = 1.0 - along;
  weights[j] = along;
  return weights;
}

}  // namespace

Vector3 at(const TriangleCorners& triangle, const Barycentric& weights) noexcept {
  return weights[0] * triangle[0] + weights[1] * triangle[1] + weights[2] * triangle[2];
}

Vector3 area_normal(const TriangleCorners& triangle) noexcept {
  return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
}

Barycentric closest_point(const TriangleCorners& triangle, const Vector3& p) noexcept {
  // Inside the prism over the triangle the foot of the perpendicular is nearest; elsewhere an edge
  // is.
  const Vector3 normal = area_normal(triangle);
  const double area2 = normal.squaredNorm();
  if (area2 > 0) {
    Barycentric weights{};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3& a = triangle[(i + 1) % 3];
      const Vector3& b = triangle[(i + 2) % 3];
      weights[i] = (b - a).cross(p - a).dot(normal) / area2;
    }
    if (weights[0] >= 0 && weights[1] >= 0 && weights[2] >= 0) return weights;
  }
  Barycentric best{};
  double best_distance2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Barycentric weights = closest_on_edge(triangle, i, (i + 1) % 3, p);
    const double distance2 = (at(triangle, weights) - p).squaredNorm();
    if (distance2 < best_distance2) {
      best_distance2 = distance2;
      best = weights;
    }
  }
  return best;
}

std::optional<Crossing> crossing(const TriangleCorners& triangle, const Vector3& from,
                                 const Vector3& to) noexcept {
  const Vector3 normal = area_normal(triangle);
  const Vector3 path = to - from;
  const double approach = -path.dot(normal);
  const double height = (from - triangle[0]).dot(normal);
  if (approach <= 0 || height < 0 || height > approach) return std::nullopt;
  Crossing found;
  found.fraction = height / approach;
  const Vector3 point = from + found.fraction * path;
  const double area2 = normal.squaredNorm();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3& a = triangle[(i + 1) % 3];
    const Vector3& b = triangle[(i + 2) % 3];
    found.weights[i] = (b - a).cross(point - a).dot(normal) / area2;
    if (found.weights[i] < 0) return std::nullopt;
  }
  return found;
}

}  // namespace irdm
