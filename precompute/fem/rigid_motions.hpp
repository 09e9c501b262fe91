#pragma once

#include <Eigen/Dense>

#include "common/geometry.hpp"

namespace irdm::precompute {

/// The six rigid motions of the nodes, (3N, 6), mass-normalised: D^T M D = Id. Three translations,
/// three infinitesimal rotations about the centre of mass.
/// @param nodes (N, 3) [m], relative to any origin
/// @param mass (N) [kg], > 0
Eigen::Matrix<double, Eigen::Dynamic, 6> rigid_motions(const Points& nodes,
                                                       const Eigen::VectorXd& mass);

}  // namespace irdm::precompute
