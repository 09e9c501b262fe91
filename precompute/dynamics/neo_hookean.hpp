#pragma once

#include "common/geometry.hpp"
#include "precompute/fem/material.hpp"

/// The compressible neo-Hookean material of one point: F = Id + du_dX, C = F^T F, J = det F,
///
///     W = mu/2 (tr C - 3 - 2 ln J) + lambda/2 (ln J)^2,
///     S = 2 dW/dC = mu (Id - C^-1) + lambda ln J C^-1      (second Piola-Kirchhoff),
///
/// linear elasticity with the same mu and lambda for small strains (Bonet and Wood, Nonlinear
/// continuum mechanics for finite element analysis, 2008, section 6.4.3). Stresses P = F S are
/// first Piola-Kirchhoff [Pa]. Of an element that is turned inside out, everything is NaN.
namespace irdm::precompute::neo_hookean {

/// [J/m^3].
double energy_density(const Matrix3& du_dX, const Lame& lame);

/// P = F (S + beta T(dE/dt)), T the linear stress, E = (C - Id)/2: no torque, and a power of
/// damping that is never negative.
/// @param dv_dX gradient of the velocity [1/s]
/// @param beta Rayleigh's [s]
Matrix3 stress(const Matrix3& du_dX, const Matrix3& dv_dX, const Lame& lame, double beta);

/// Mean stress of a step of h [s], for which its work is exactly the change of energy plus a
/// dissipation (Gonzalez, Exact energy and momentum conserving algorithms for general models in
/// nonlinear elasticity, Comput. Methods Appl. Mech. Eng. 190, 2000):
///
///     P = F_mid (S(C_mid) + (2 W1 - 2 W0 - S(C_mid) : dC) / (dC : dC) dC + beta T(dC / 2h)),
///
/// F_mid and C_mid the means of both ends, dC the change of C.
Matrix3 mean_stress(const Matrix3& du_dX0, const Matrix3& du_dX1, double h, const Lame& lame,
                    double beta);

/// What d(P g_i)/du_j is, f_i = -volume P g_i the force on node i of shape function gradient g_i:
///
///     (g_i^T S g_j) Id + lambda a_i a_j^T + (mu - lambda ln J) (a_j a_i^T + a_i^T a_j Id),
///
/// a = F^-T g [Pa/m^2].
class Tangent {
 public:
  Tangent(const Matrix3& du_dX, const Lame& lame);
  Matrix3 block(const Vector3& gi, const Vector3& gj) const;

 private:
  Matrix3 S_;
  Matrix3 inverse_F_;
  double lambda_;
  double mu_;  // mu - lambda ln J
};

}  // namespace irdm::precompute::neo_hookean
