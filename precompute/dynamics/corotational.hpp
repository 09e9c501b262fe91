#pragma once

#include "common/geometry.hpp"
#include "precompute/fem/material.hpp"

namespace irdm::precompute {

/// The rotation Q nearest to F, which maximises tr(Q^T F): the orthogonal factor of the polar
/// decomposition F = Q S where det F > 0, by Newton's iteration Q <- (Q + Q^-T) / 2 with scaling
/// (Higham, Computing the polar decomposition, SIAM J. Sci. Stat. Comput. 7, 1986). Where F is
/// singular or turned inside out, from its singular values; det Q = 1 always.
Matrix3 polar_rotation(const Matrix3& F);

}  // namespace irdm::precompute

/// The corotational material of one point: F = Id + du_dX = R S by polar decomposition, strain
/// e = S - Id, energy density mu |e|^2 + lambda/2 tr(e)^2, stress T(e) = 2 mu e + lambda tr(e) Id.
/// Stresses P are first Piola-Kirchhoff [Pa]: a nodal force is -volume P grad(shape function).
namespace irdm::precompute::corotational {

/// e = S - Id, without cancellation: correct digits for strains of any size.
Matrix3 strain(const Matrix3& du_dX);

/// Energy density [J/m^3] of a strain.
double energy_density(const Matrix3& strain, const Lame& lame);

/// P = R T(e) plus beta times the stress whose power is T(dS/dt) : dS/dt, which has no torque.
/// @param dv_dX gradient of the velocity [1/s]
/// @param beta Rayleigh's [s]
Matrix3 stress(const Matrix3& du_dX, const Matrix3& dv_dX, const Lame& lame, double beta);

/// Mean stress of a step that takes the gradient of the displacement from du_dX0 (strain e0) to
/// du_dX1 (e1) in the time h [s], for which its work is exactly the change of energy plus a
/// dissipation:
///
///     P = F_mid Sigma,  F_mid = (F0 + F1)/2,  S_mid = (S0 + S1)/2,
///     S_mid Sigma + Sigma S_mid = 2 T(e_mid + beta (e1 - e0)/h).
///
/// Sigma is symmetric, hence no torque about the middle of the step. With F1^T F1 - F0^T F0 =
/// S1^2 - S0^2 the work P : (F1 - F0) comes out as T(...) : (S1 - S0), which is the difference of a
/// quadratic energy plus beta/h T(e1 - e0) : (e1 - e0) >= 0. This is Simo and Tarnow's stress
/// (S_mid instead of C_mid because the energy is quadratic in S, not in C = F^T F), a discrete
/// gradient in the sense of Gonzalez, Exact energy and momentum conserving algorithms for general
/// models in nonlinear elasticity, Comput. Methods Appl. Mech. Eng. 190 (2000).
Matrix3 mean_stress(const Matrix3& du_dX0, const Matrix3& strain0, const Matrix3& du_dX1, double h,
                    const Lame& lame, double beta);

}  // namespace irdm::precompute::corotational
