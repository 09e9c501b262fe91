#pragma once

#include <Eigen/Dense>

namespace irdm::precompute {

/// Nodal loads of a body all of which is accelerated alike, as gravity does: shape (3N, 3), one
/// column an axis, m_i on node i along it. [kg]
/// @param mass lumped (N) [kg]
Eigen::Matrix<double, Eigen::Dynamic, 3> uniform_loads(const Eigen::VectorXd& mass);

}  // namespace irdm::precompute
