#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "common/geometry.hpp"

namespace irdm {

/// Nodes that one fingertip can press on.
inline constexpr int kMaxPatchNodes = 320;

/// How the force of one contact is spread over surface nodes: weights that sum to one. The
/// contact's displacement is the same weighted mean, so that what the force does is what the
/// contact feels (no energy comes from nowhere). No memory taken.
struct ContactPatch {
  int count = 0;
  std::array<int, kMaxPatchNodes> nodes;
  std::array<double, kMaxPatchNodes> weights;

  ContactPatch() = default;
  /// A point: its triangle's corners, those of no weight left out.
  explicit ContactPatch(const SurfacePoint& point) noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      if (point.weights[i] != 0.0) add(point.nodes[i], point.weights[i]);
    }
  }
  void add(int node, double weight) noexcept {
    nodes[static_cast<std::size_t>(count)] = node;
    weights[static_cast<std::size_t>(count)] = weight;
    ++count;
  }
};

/// Same nodes and weights in the same order.
inline bool operator==(const ContactPatch& a, const ContactPatch& b) noexcept {
  return a.count == b.count &&
         std::equal(a.nodes.begin(), a.nodes.begin() + a.count, b.nodes.begin()) &&
         std::equal(a.weights.begin(), a.weights.begin() + a.count, b.weights.begin());
}

/// The weighted mean over a patch of a quantity that is known at nodes.
template <typename NodeValue>
Vector3 mean(const ContactPatch& patch, const NodeValue& value) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
    sum += patch.weights[i] * value(patch.nodes[i]);
  }
  return sum;
}

}  // namespace irdm
