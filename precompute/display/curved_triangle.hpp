#pragma once

#include <array>

#include "common/geometry.hpp"

namespace irdm::precompute {

/// A curved point-normal triangle: the cubic Bezier patch through three corners that is
/// perpendicular to their normals there. Two that share an edge, its ends and their normals meet
/// without a gap. (Vlachos, Peters, Boyd, Mitchell: Curved PN triangles, I3D 2001, section 3.)
class CurvedTriangle {
 public:
  /// @param normals unit, of the corners
  /// @param straight whether the edge from corner i to the next one stays straight
  CurvedTriangle(const std::array<Vector3, 3>& corners, const std::array<Vector3, 3>& normals,
                 const std::array<bool, 3>& straight);

  /// Its point at barycentric weights.
  Vector3 at(const Vector3& weights) const;

 private:
  std::array<Vector3, 3> corners_;
  /// Between corner i and the next one: a third of the way from each.
  std::array<std::array<Vector3, 2>, 3> edges_;
  Vector3 middle_;
};

}  // namespace irdm::precompute
