#pragma once

#include <array>
#include <vector>

#include "common/model/model.hpp"

namespace irdm {

/// A face of a finite element on the surface. The element interpolates the displacement of the face
/// between its nodes: three nodes of a linear element, six of a quadratic one.
struct SurfaceFace {
  int element = -1;  ///< the tetrahedron below it; -1 if the model has no tetrahedra there
  int node_count = 3;
  /// Surface nodes: the corners a, b, c, counterclockwise as seen from outside, then the mid-side
  /// nodes of ab, bc and ca.
  std::array<int, 6> nodes{};
  /// The surface triangles that cover the face: first the middle one, then those at a, b and c. A
  /// face with three nodes has only the first.
  std::array<int, 4> triangles{};

  /// Returns the shape functions of the nodes at a point of the face.
  /// @param at barycentric coordinates of the point with respect to a, b, c
  std::array<double, 6> weights(const std::array<double, 3>& at) const noexcept;
};

/// Returns the faces that cover the surface of a model. Each surface triangle belongs to exactly
/// one face.
std::vector<SurfaceFace> surface_faces(const ModelMesh& mesh);

}  // namespace irdm
