#pragma once

#include <Eigen/Sparse>

#include "common/model/model.hpp"

/// Bodies at rest computed by finite elements on the whole mesh of a model, K u = f, without modes
/// and without R.
namespace irdm::test {

/// K of the model's mesh and material, (3N, 3N) [N/m].
Eigen::SparseMatrix<double> stiffness_of(const Model& model);

/// Displacement of the surface nodes (n, 3) [m], B, of a free body under a load that its inertia
/// balances; rigid motion removed with the nodes' masses.
/// @param K stiffness (3N, 3N)  @param load (3N) [N]
Points balanced_displacement(const Model& model, const Eigen::SparseMatrix<double>& K,
                             const Eigen::VectorXd& load);

/// Of a body under its own weight, the nodes in the lowest plane along an axis clamped.
/// @param gravity [m/s^2], B
Points clamped_sag(const Model& model, int axis, const Vector3& gravity);

/// Weight of all nodes (3N) [N]. @param gravity [m/s^2], B
Eigen::VectorXd weight_of(const Model& model, const Vector3& gravity);

}  // namespace irdm::test
