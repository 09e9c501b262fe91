#pragma once

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

}  // namespace irdm::precompute
