#include "precompute/check/static_reference.hpp"

#include "common/dense_algebra.hpp"
#include "common/error.hpp"
#include "precompute/fem/rigid_motions.hpp"

namespace irdm::precompute {

Matrix3 rigid_mobility(const BodyProperties& body, const Vector3& at, const Vector3& from) {
  if (body.support == Support::kFixed) return Matrix3::Zero();
  return Matrix3::Identity() / body.mass - skew(at) * body.inertia.inverse() * skew(from);
}

StaticReference::StaticReference(const Model& model)
    : mass_(model.mesh.node_mass.replicate(1, 3).transpose().reshaped()),
      rigid_(rigid_motions(model.mesh.nodes, model.mesh.node_mass)) {
  TetMesh mesh;
  mesh.nodes = model.mesh.nodes;
  mesh.tets = model.mesh.tets;
  SparseMatrix stiffness = assemble_stiffness(mesh, model.material);
  hold_determinately(stiffness, mesh.nodes);
  try {
    solver_->factorise(stiffness);
  } catch (const Error&) {
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
  Eigen::VectorXd u = solver_->solve(force);
  u -= rigid_ * (rigid_.transpose() * (mass_.asDiagonal() * u));
  return u(surface_);
}

StaticComparison compare_static(const Eigen::VectorXd& found, const Eigen::VectorXd& expected,
                                const Eigen::MatrixXd& surface_rigid) {
  const Eigen::VectorXd difference = found - expected;
  const Eigen::VectorXd rigid = surface_rigid * least_squares(surface_rigid, difference);
  const double scale = expected.cwiseAbs().maxCoeff();
  return {rigid.cwiseAbs().maxCoeff() / scale, (difference - rigid).cwiseAbs().maxCoeff() / scale};
}

}  // namespace irdm::precompute
