#pragma once

#include <Eigen/Dense>

#include "common/geometry.hpp"
#include "precompute/fem/material.hpp"

namespace irdm::precompute {

/// Adds what one quadrature point contributes to an element's stiffness.
/// @param gradient of the shape functions there [1/m], one a row
/// @param volume that the point stands for [m^3]
/// @param stiffness (3 nodes, 3 nodes) [N/m], index 3 node + axis
template <int kNodes>
void add_strain_energy(const Eigen::Matrix<double, kNodes, 3>& gradient, double volume,
                       const Lame& lame, Eigen::Matrix<double, 3 * kNodes, 3 * kNodes>& stiffness) {
  for (int i = 0; i < kNodes; ++i) {
    const Vector3 gi = gradient.row(i).transpose();
    for (int j = 0; j < kNodes; ++j) {
      const Vector3 gj = gradient.row(j).transpose();
      stiffness.template block<3, 3>(3 * i, 3 * j) +=
          volume * (lame.lambda * gi * gj.transpose() +
                    lame.mu * (gj * gi.transpose() + gi.dot(gj) * Matrix3::Identity()));
    }
  }
}

}  // namespace irdm::precompute
