#include "precompute/fem/rigid_motions.hpp"

#include <cmath>

#include "common/dense_algebra.hpp"
#include "precompute/fem/mass_properties.hpp"

namespace irdm::precompute {
namespace {

// A spring from a node to the ground along a direction.
void hold(SparseMatrix& stiffness, Eigen::Index node, const Vector3& along, double spring) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      stiffness.coeffRef(3 * node + i, 3 * node + j) += spring * along[i] * along[j];
    }
  }
}

}  // namespace

void hold_determinately(SparseMatrix& stiffness, const Points& nodes) {
  const double spring = Eigen::VectorXd(stiffness.diagonal()).maxCoeff();
  Eigen::Index a = 0;
  Eigen::Index b = 0;
  Eigen::Index c = 0;
  nodes.rowwise().squaredNorm().maxCoeff(&a);
  (nodes.rowwise() - nodes.row(a)).rowwise().squaredNorm().maxCoeff(&b);
  const Vector3 line = (nodes.row(b) - nodes.row(a)).normalized().transpose();
  Eigen::VectorXd distance(nodes.rows());
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    distance(i) = line.cross(Vector3((nodes.row(i) - nodes.row(a)).transpose())).norm();
  }
  distance.maxCoeff(&c);
  const Vector3 out = line.cross(Vector3((nodes.row(c) - nodes.row(a)).transpose())).normalized();
  for (int axis = 0; axis < 3; ++axis) hold(stiffness, a, Vector3::Unit(axis), spring);
  hold(stiffness, b, out, spring);
  hold(stiffness, b, line.cross(out), spring);
  hold(stiffness, c, out, spring);
}

Eigen::Matrix<double, Eigen::Dynamic, 6> rigid_motions(const Points& nodes,
                                                       const Eigen::VectorXd& mass) {
  const MassProperties body = nodal_mass_properties(nodes, mass);
  // Principal axes make the rotations orthogonal to each other.
  const SymmetricEigen principal = symmetric_eigenpairs(body.inertia);
  const Matrix3 axes = principal.vectors;
  Eigen::Matrix<double, Eigen::Dynamic, 6> motions(3 * nodes.rows(), 6);
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    const Vector3 arm = nodes.row(i).transpose() - body.centre_of_mass;
    motions.block<3, 3>(3 * i, 0) = Matrix3::Identity() / std::sqrt(body.mass);
    for (int k = 0; k < 3; ++k) {
      motions.block<3, 1>(3 * i, 3 + k) =
          Vector3(axes.col(k)).cross(arm) / std::sqrt(principal.values(k));
    }
  }
  return motions;
}

}  // namespace irdm::precompute
