#pragma once

#include <Eigen/Dense>

#include "common/geometry.hpp"
#include "common/response/spin_products.hpp"

namespace irdm::precompute {

/// Nodal loads of a body that turns: shape (3N, 6), one column a product of SpinProducts. With
/// q = spin_products(w) the columns add up to m_i (|w|^2 X_i - w (w . X_i)) on node i, the
/// centrifugal force [N] where w is in rad/s. [kg m]
/// @param nodes X (N, 3) [m], B: the centre of mass is the origin
/// @param mass lumped (N) [kg]
Eigen::Matrix<double, Eigen::Dynamic, kSpinProducts> centrifugal_loads(const Points& nodes,
                                                                       const Eigen::VectorXd& mass);

}  // namespace irdm::precompute
