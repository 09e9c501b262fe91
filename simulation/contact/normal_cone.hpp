#pragma once

#include <cstddef>
#include <span>

#include "common/geometry.hpp"

namespace irdm {

/// Outward normals that a convex surface has at an edge or a corner: the convex cone of those of
/// the faces that meet there. Which of them is nearest to a direction, unit.
/// @param faces unit, at least one, no two alike; of more than two, those three that come first
///   make the inside of the cone
inline Vector3 nearest_in_cone(std::span<const Vector3> faces, const Vector3& direction) noexcept {
  if (faces.size() > 2) {
    Matrix3 corner;
    corner << faces[0], faces[1], faces[2];
    if ((corner.inverse() * direction).minCoeff() > 0.0) return direction;
  }
  Vector3 nearest = faces[0];
  const auto offer = [&](const Vector3& normal) {
    if (normal.dot(direction) > nearest.dot(direction)) nearest = normal;
  };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    offer(faces[i]);
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3 edge = faces[i].cross(faces[j]).normalized();
      const Vector3 across = (direction - direction.dot(edge) * edge).normalized();
      if (faces[i].cross(across).dot(edge) > 0.0 && across.cross(faces[j]).dot(edge) > 0.0) {
        offer(across);
      }
    }
  }
  return nearest;
}

}  // namespace irdm
