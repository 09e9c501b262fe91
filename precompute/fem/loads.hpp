#pragma once

#include <Eigen/Dense>

#include "common/geometry.hpp"
#include "common/response/modal_response.hpp"

namespace irdm::precompute {

/// Nodal loads of a body that turns: shape (3N, 6), one column a product of SpinProducts. With
/// q = spin_products(w) the columns add up to m_i (|w|^2 X_i - w (w . X_i)) on node i, the
/// centrifugal force [N] where w is in rad/s. [kg m]
/// @param nodes X (N, 3) [m], B: the centre of mass is the origin
/// @param mass lumped (N) [kg]
Eigen::Matrix<double, Eigen::Dynamic, kSpinProducts> centrifugal_loads(const Points& nodes,
                                                                       const Eigen::VectorXd& mass);

/// Nodal loads of a body all of which is accelerated alike, as gravity does: shape (3N, 3), one
/// column an axis, m_i on node i along it. [kg]
/// @param mass lumped (N) [kg]
Eigen::Matrix<double, Eigen::Dynamic, 3> uniform_loads(const Eigen::VectorXd& mass);

}  // namespace irdm::precompute
