#pragma once

#include <Eigen/Dense>

#include "common/geometry.hpp"
#include "precompute/fem/assembly.hpp"

namespace irdm::precompute {

/// Holds a free body by six springs to the ground at three nodes far from each other. Under loads
/// that are in balance they carry no force, so that they change nothing but the rigid motion; the
/// stiffness becomes positive definite.
/// @param stiffness (3N, 3N) [N/m], with entries for each node's own block
/// @param nodes (N, 3) [m], relative to any origin inside the body
void hold_determinately(SparseMatrix& stiffness, const Points& nodes);

/// The six rigid motions of the nodes, (3N, 6), mass-normalised: D^T M D = Id. Three translations,
/// three infinitesimal rotations about the centre of mass.
/// @param nodes (N, 3) [m], relative to any origin
/// @param mass (N) [kg], > 0
Eigen::Matrix<double, Eigen::Dynamic, 6> rigid_motions(const Points& nodes,
                                                       const Eigen::VectorXd& mass);

}  // namespace irdm::precompute
