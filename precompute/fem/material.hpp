#pragma once

#include <Eigen/Dense>

#include "common/geometry.hpp"
#include "common/model/model.hpp"

namespace irdm::precompute {

/// Lame's parameters of linear isotropic elasticity.
struct Lame {
  double lambda;  ///< [Pa]
  double mu;      ///< shear modulus [Pa]
};

/// E > 0 and -1 < nu < 0.5.
inline Lame lame_parameters(const Material& material) {
  const double e = material.youngs_modulus;
  const double nu = material.poisson_ratio;
  return {e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu))};
}

/// Stress [Pa] = lambda tr(strain) Id + 2 mu strain.
/// @param du_dx gradient of the displacement: entry (a, b) is d u_a / d x_b
inline Matrix3 lame_stress(const Matrix3& du_dx, const Lame& lame) {
  const Matrix3 strain = 0.5 * (du_dx + du_dx.transpose());
  return lame.lambda * strain.trace() * Matrix3::Identity() + 2.0 * lame.mu * strain;
}

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
