#include "common/surface/surface_tree.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

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

double least_distance2(const TriangleCorners& triangle, const Vector3& p) noexcept {
  const auto low = triangle[0].array().min(triangle[1].array()).min(triangle[2].array());
  const auto high = triangle[0].array().max(triangle[1].array()).max(triangle[2].array());
  return (low - p.array()).max(p.array() - high).max(0.0).square().sum();
}

std::optional<Crossing> crossing(const TriangleCorners& triangle, const Vector3& from,
                                 const Vector3& to, double slack) noexcept {
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
    if (found.weights[i] < -slack) return std::nullopt;
  }
  return found;
}

namespace {
constexpr int kLeafSize = 4;
// Halving the list at every level keeps the depth at log2 of the number of triangles.
constexpr int kMaxDepth = 40;
// Of fractions of a way and of barycentric weights: more than what rounding makes.
constexpr double kRounding = 1e-9;

// Fraction of a way at which it comes into a box; 2: not at all.
double entry(const Eigen::AlignedBox3d& box, const Vector3& from, const Vector3& way) noexcept {
  constexpr double kMisses = 2.0;
  double enters = 0.0;
  double leaves = 1.0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (way[i] == 0) {
      if (from[i] < box.min()[i] || from[i] > box.max()[i]) return kMisses;
      continue;
    }
    const double one = (box.min()[i] - from[i]) / way[i];
    const double other = (box.max()[i] - from[i]) / way[i];
    enters = std::max(enters, std::min(one, other));
    leaves = std::min(leaves, std::max(one, other));
  }
  return enters <= leaves + kRounding ? enters - kRounding : kMisses;
}

}  // namespace

SurfaceTree::SurfaceTree(const ModelMesh& mesh) {
  const auto count = static_cast<std::size_t>(mesh.triangles.rows());
  triangles_.reserve(count);
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    triangles_.push_back({mesh.rest_position(mesh.triangles(t, 0)),
                          mesh.rest_position(mesh.triangles(t, 1)),
                          mesh.rest_position(mesh.triangles(t, 2))});
  }
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.reserve(2 * count);
  build(0, static_cast<int>(count));
}

void SurfaceTree::build(int begin, int end) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  Eigen::AlignedBox3d box;
  for (int i = begin; i < end; ++i) {
    for (const Vector3& corner :
         triangles_[static_cast<std::size_t>(order_[static_cast<std::size_t>(i)])]) {
      box.extend(corner);
    }
  }
  nodes_[self].box = box;
  if (end - begin <= kLeafSize) {
    nodes_[self].first = begin;
    nodes_[self].count = end - begin;
    return;
  }
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto centre = [&](int t) {
    const auto& corners = triangles_[static_cast<std::size_t>(t)];
    return corners[0][axis] + corners[1][axis] + corners[2][axis];
  };
  const int middle = (begin + end) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](int a, int b) {
                     const double left = centre(a);
                     const double right = centre(b);
                     return left < right || (left == right && a < b);
                   });
  build(begin, middle);
  nodes_[self].first = static_cast<int>(nodes_.size());
  build(middle, end);
}

int SurfaceTree::closest_triangle(const Vector3& p, int guess) const noexcept {
  const auto distance2_from = [&](int triangle) {
    const auto& corners = triangles_[static_cast<std::size_t>(triangle)];
    return (at(corners, closest_point(corners, p)) - p).squaredNorm();
  };
  std::array<int, kMaxDepth + 1> stack{};
  int depth = 0;
  stack[static_cast<std::size_t>(depth++)] = 0;
  int best = guess;
  double best_distance2 = distance2_from(guess);
  // So that rounding hides no triangle that is as near, whatever the guess.
  const auto farther = [&](double box_distance2) {
    return box_distance2 > (1.0 + kRounding) * best_distance2;
  };
  while (depth > 0) {
    const int index = stack[static_cast<std::size_t>(--depth)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (farther(node.box.squaredExteriorDistance(p))) continue;
    if (node.count == 0) {
      int near = index + 1;
      int far = node.first;
      const auto distance2 = [&](int child) {
        return nodes_[static_cast<std::size_t>(child)].box.squaredExteriorDistance(p);
      };
      if (distance2(far) < distance2(near)) std::swap(near, far);
      stack[static_cast<std::size_t>(depth++)] = far;
      stack[static_cast<std::size_t>(depth++)] = near;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const int t = order_[static_cast<std::size_t>(i)];
      if (farther(least_distance2(triangles_[static_cast<std::size_t>(t)], p))) continue;
      const double distance2 = distance2_from(t);
      if (distance2 < best_distance2 || (distance2 == best_distance2 && t < best)) {
        best_distance2 = distance2;
        best = t;
      }
    }
  }
  return best;
}

int SurfaceTree::overlapping(const Eigen::AlignedBox3d& box, std::span<int> found) const noexcept {
  std::array<int, kMaxDepth + 1> stack{};
  int depth = 0;
  stack[static_cast<std::size_t>(depth++)] = 0;
  std::size_t count = 0;
  while (depth > 0) {
    const int index = stack[static_cast<std::size_t>(--depth)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!node.box.intersects(box)) continue;
    if (node.count == 0) {
      stack[static_cast<std::size_t>(depth++)] = node.first;
      stack[static_cast<std::size_t>(depth++)] = index + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const int t = order_[static_cast<std::size_t>(i)];
      Eigen::AlignedBox3d own;
      for (const Vector3& corner : triangles_[static_cast<std::size_t>(t)]) own.extend(corner);
      if (!own.intersects(box)) continue;
      if (count == found.size()) return static_cast<int>(count);
      found[count++] = t;
    }
  }
  return static_cast<int>(count);
}

std::optional<SurfaceTree::Entry> SurfaceTree::first_entry(const Vector3& from,
                                                           const Vector3& to) const noexcept {
  const Vector3 way = to - from;
  std::array<int, kMaxDepth + 1> stack{};
  int depth = 0;
  stack[static_cast<std::size_t>(depth++)] = 0;
  std::optional<Entry> first;
  while (depth > 0) {
    const int index = stack[static_cast<std::size_t>(--depth)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (entry(node.box, from, way) > (first ? first->fraction : 1.0)) continue;
    if (node.count == 0) {
      stack[static_cast<std::size_t>(depth++)] = node.first;
      stack[static_cast<std::size_t>(depth++)] = index + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const int t = order_[static_cast<std::size_t>(i)];
      const auto found = crossing(triangles_[static_cast<std::size_t>(t)], from, to, kRounding);
      if (found && (!first || found->fraction < first->fraction)) first = Entry{t, found->fraction};
    }
  }
  return first;
}

}  // namespace irdm
