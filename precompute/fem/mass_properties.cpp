#include "precompute/fem/mass_properties.hpp"

#include <cmath>

namespace irdm::precompute {
namespace {

// Sums of mass, m x and m x x^T about a reference point near the body, so that a body far from the
// origin loses no digits.
struct Moments {
  double zeroth = 0.0;
  Vector3 first = Vector3::Zero();
  Matrix3 second = Matrix3::Zero();
};

MassProperties about_centre(const Moments& m, const Vector3& reference) {
  const Vector3 centre = m.first / m.zeroth;
  const Matrix3 second = m.second - m.zeroth * centre * centre.transpose();
  return {m.zeroth, reference + centre, second.trace() * Matrix3::Identity() - second};
}

}  // namespace

MassProperties solid_mass_properties(const TetMesh& mesh, double density) {
  const Vector3 reference = mesh.nodes.colwise().mean().transpose();
  Moments sum;
  for (int e = 0; e < mesh.tet_count(); ++e) {
    const double m = density * signed_volume(mesh, e);
    Vector3 corner_sum = Vector3::Zero();
    Matrix3 corner_products = Matrix3::Zero();
    for (int i = 0; i < 4; ++i) {
      const Vector3 x = mesh.position(mesh.tets(e, i)) - reference;
      corner_sum += x;
      corner_products += x * x.transpose();
    }
    sum.zeroth += m;
    sum.first += 0.25 * m * corner_sum;
    // Integral of b_i b_j over a tetrahedron: V (1 + [i = j]) / 20.
    sum.second += 0.05 * m * (corner_products + corner_sum * corner_sum.transpose());
  }
  return about_centre(sum, reference);
}

MassProperties nodal_mass_properties(const Points& nodes, const Eigen::VectorXd& mass) {
  const Vector3 reference = nodes.colwise().mean().transpose();
  Moments sum;
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    const Vector3 x = nodes.row(i).transpose() - reference;
    sum.zeroth += mass(i);
    sum.first += mass(i) * x;
    sum.second += mass(i) * x * x.transpose();
  }
  return about_centre(sum, reference);
}

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
