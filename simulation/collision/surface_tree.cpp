#include "simulation/collision/surface_tree.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "simulation/collision/triangle.hpp"

namespace irdm {
namespace {
constexpr int kLeafSize = 4;
// Halving the list at every level keeps the depth at log2 of the number of triangles.
constexpr int kMaxDepth = 40;
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

int SurfaceTree::closest_triangle(const Vector3& p) const noexcept {
  std::array<int, kMaxDepth + 1> stack{};
  int depth = 0;
  stack[static_cast<std::size_t>(depth++)] = 0;
  int best = 0;
  double best_distance2 = std::numeric_limits<double>::infinity();
  while (depth > 0) {
    const int index = stack[static_cast<std::size_t>(--depth)];
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.box.squaredExteriorDistance(p) > best_distance2) continue;
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
      const auto& corners = triangles_[static_cast<std::size_t>(t)];
      const double distance2 = (at(corners, closest_point(corners, p)) - p).squaredNorm();
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

}  // namespace irdm
