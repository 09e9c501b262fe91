#pragma once

#include <Eigen/Dense>

#include "common/config/range.hpp"
#include "common/geometry.hpp"
#include "common/model/model.hpp"

namespace irdm::precompute {

/// Poisson's ratios that are computed with. Nearer to -1 or 0.5 one of the two stiffnesses of the
/// material, of shape or of volume, is lost in the rounding of the other.
inline constexpr Range kPoissonRatio = between(-0.999999, 0.499999);

/// Lame's parameters of linear isotropic elasticity.
struct Lame {
  double lambda;  ///< [Pa]
  double mu;      ///< shear modulus [Pa]
};

/// @param e Young's modulus [Pa], > 0
/// @param nu Poisson's ratio, in (-1, 0.5)
inline Lame lame_parameters(double e, double nu) {
  return {e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu))};
}

/// Of the body where it has no values of its elements.
inline Lame lame_parameters(const Material& material) {
  return lame_parameters(material.youngs_modulus, material.poisson_ratio);
}

/// Of a tetrahedron of a body that deforms.
inline Lame lame_parameters(const Material& material, Eigen::Index element) {
  const ElementMaterials& own = material.elements;
  if (own.empty()) return lame_parameters(material);
  const auto e = static_cast<std::size_t>(element);
  return lame_parameters(own.youngs_modulus[e], own.poisson_ratio[e]);
}

/// Of a tetrahedron [kg/m^3].
inline double density_of(const Material& material, Eigen::Index element) {
  const ElementMaterials& own = material.elements;
  return own.empty() ? material.density : own.density[static_cast<std::size_t>(element)];
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
