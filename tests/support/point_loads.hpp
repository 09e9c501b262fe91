#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "common/geometry.hpp"

namespace irdm::test {

/// Loads of 1 N, each on one surface node: (3n, n).
/// @param directions unit vectors, one a surface node, B
inline Eigen::SparseMatrix<double> point_loads(const std::vector<Vector3>& directions) {
  const auto nodes = static_cast<int>(directions.size());
  Eigen::SparseMatrix<double> loads(3 * nodes, nodes);
  for (int node = 0; node < nodes; ++node) {
    const Vector3& d = directions[static_cast<std::size_t>(node)];
    for (int axis = 0; axis < 3; ++axis) loads.insert(3 * node + axis, node) = d(axis);
  }
  return loads;
}

}  // namespace irdm::test
