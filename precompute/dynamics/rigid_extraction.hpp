#pragma once

#include <Eigen/Dense>

#include "common/geometry.hpp"

/// Rigid motion of a deformed body and what is left without it (section 3.2 of the paper). Rest
/// positions X are relative to the centre of mass, displacements are x - X in W.
namespace irdm::precompute {

/// Weight of a node in the sum of squared distances that defines the rotation.
enum class RotationWeights { kMass, kNone };

struct RigidMotion {
  Vector3 translation;  ///< of the centre of mass [m], (6)(7)
  Matrix3 rotation;     ///< Q
};

/// Translation of the centre of mass, and the rotation Q that minimises
/// sum_i w_i |x_i - c - Q X_i|^2, found by iteration (see polar_rotation). Weighted with the mass,
/// the elastic part has neither linear nor angular momentum to first order: sum m e = 0 and
/// sum m X x e = 0 hold exactly.
/// @param rest (N, 3) [m], centred
/// @param displacement (N, 3) [m]
/// @param mass (N) [kg]
RigidMotion extract_rigid_motion(const Points& rest, const Points& displacement,
                                 const Eigen::VectorXd& mass, RotationWeights weights);

/// e_i = Q^T (x_i - c) - X_i, (N, 3) [m], B.
Points elastic_part(const Points& rest, const Points& displacement, const RigidMotion& motion);

/// The same for infinitesimal displacements: what is left of u when u_c + w x X is taken off.
Points linear_elastic_part(const Points& rest, const Points& displacement,
                           const Eigen::VectorXd& mass, RotationWeights weights);

}  // namespace irdm::precompute
