#include "precompute/fem/rigid_motions.hpp"

#include <cmath>

#include "precompute/fem/mass_properties.hpp"

namespace irdm::precompute {

Eigen::Matrix<double, Eigen::Dynamic, 6> rigid_motions(const Points& nodes,
                                                       const Eigen::VectorXd& mass) {
  const MassProperties body = nodal_mass_properties(nodes, mass);
  // Principal axes make the rotations orthogonal to each other.
  const Eigen::SelfAdjointEigenSolver<Matrix3> principal(body.inertia);
  const Matrix3& axes = principal.eigenvectors();
  Eigen::Matrix<double, Eigen::Dynamic, 6> motions(3 * nodes.rows(), 6);
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    const Vector3 arm = nodes.row(i).transpose() - body.centre_of_mass;
    motions.block<3, 3>(3 * i, 0) = Matrix3::Identity() / std::sqrt(body.mass);
    for (int k = 0; k < 3; ++k) {
      motions.block<3, 1>(3 * i, 3 + k) =
          Vector3(axes.col(k)).cross(arm) / std::sqrt(principal.eigenvalues()(k));
    }
  }
  return motions;
}

}  // namespace irdm::precompute
