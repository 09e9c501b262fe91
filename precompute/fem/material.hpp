#pragma once

#include "common/model/model.hpp"

namespace irdm::precompute {

/// Lame's parameters of linear isotropic elasticity: stress = lambda tr(strain) Id + 2 mu strain.
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

}  // namespace irdm::precompute
