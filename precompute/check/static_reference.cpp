#include "precompute/check/static_reference.hpp"

#include "common/error.hpp"
#include "precompute/fem/rigid_motions.hpp"

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

// Six springs at three nodes far from each other: they hold the body and, under a load that is in
// balance, carry no force, so that they change nothing but the rigid motion.
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

}  // namespace

StaticReference::StaticReference(const Model& model)
    : mass_(model.mesh.node_mass.replicate(1, 3).transpose().reshaped()),
      rigid_(rigid_motions(model.mesh.nodes, model.mesh.node_mass)) {
  TetMesh mesh;
  mesh.nodes = model.mesh.nodes;
  mesh.tets = model.mesh.tets;
  SparseMatrix stiffness = assemble_stiffness(mesh, lame_parameters(model.material));
  hold_determinately(stiffness, mesh.nodes);
  solver_.compute(stiffness);
  if (solver_.info() != Eigen::Success) {
    throw Error("/mesh", "its stiffness cannot be factorised",
                "make the model again with irdm-precompute");
  }
  for (const int node : model.mesh.surface_nodes) {
    for (int axis = 0; axis < 3; ++axis) surface_.push_back(3 * node + axis);
  }
  surface_rigid_ = rigid_(surface_, Eigen::all);
}

Eigen::VectorXd StaticReference::displacement(int b) const {
  const int dof = surface_[static_cast<std::size_t>(b)];
  Eigen::VectorXd force = -mass_.cwiseProduct(rigid_ * rigid_.row(dof).transpose());
  force(dof) += 1.0;
  Eigen::VectorXd u = solver_.solve(force);
  u -= rigid_ * (rigid_.transpose() * (mass_.asDiagonal() * u));
  return u(surface_);
}

StaticComparison compare_static(const Eigen::VectorXd& found, const Eigen::VectorXd& expected,
                                const Eigen::MatrixXd& surface_rigid) {
  const Eigen::VectorXd difference = found - expected;
  const Eigen::VectorXd rigid =
      surface_rigid * surface_rigid.colPivHouseholderQr().solve(difference);
  const double scale = expected.cwiseAbs().maxCoeff();
  return {rigid.cwiseAbs().maxCoeff() / scale, (difference - rigid).cwiseAbs().maxCoeff() / scale};
}

}  // namespace irdm::precompute
