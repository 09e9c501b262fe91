#include "tests/support/spinning_fem.hpp"

#include <Eigen/SparseLU>

#include "precompute/dynamics/implicit_midpoint.hpp"
#include "precompute/dynamics/rigid_extraction.hpp"
#include "precompute/fem/assembly.hpp"
#include "precompute/fem/rigid_motions.hpp"

namespace irdm::test {
namespace {

using namespace irdm::precompute;

TetMesh mesh_of(const Model& model) {
  return {model.mesh.nodes, model.mesh.tets, {}};
}

Points at_surface(const Model& model, const Points& all) {
  return all(model.mesh.surface_nodes, Eigen::all);
}

// M W^2 of all nodes (3N, 3N): minus the centrifugal force per displacement.
SparseMatrix softening_matrix(const Model& model, const Vector3& w) {
  const Matrix3 W2 = skew(w) * skew(w);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < model.mesh.nodes.rows(); ++i) {
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        entries.emplace_back(3 * i + a, 3 * i + b, model.mesh.node_mass(i) * W2(a, b));
      }
    }
  }
  SparseMatrix matrix(3 * model.mesh.nodes.rows(), 3 * model.mesh.nodes.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// (A, C; C^T, 0)
SparseMatrix bordered(const SparseMatrix& A, const Eigen::MatrixXd& C) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < A.outerSize(); ++k) {
    for (SparseMatrix::InnerIterator it(A, k); it; ++it) {
      entries.emplace_back(static_cast<int>(it.row()), static_cast<int>(it.col()), it.value());
    }
  }
  const auto n = static_cast<int>(A.rows());
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < C.cols(); ++k) {
      entries.emplace_back(i, n + k, C(i, k));
      entries.emplace_back(n + k, i, C(i, k));
    }
  }
  SparseMatrix matrix(n + C.cols(), n + C.cols());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Matrix3 inertia_of(const Points& x, const Eigen::VectorXd& mass) {
  Matrix3 inertia = Matrix3::Zero();
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Matrix3 cross = skew(x.row(i).transpose());
    inertia -= mass(i) * cross * cross;
  }
  return inertia;
}

}  // namespace

Points static_bulge(const Model& model, const Vector3& w, SpinSoftening softening) {
  SparseMatrix K = assemble_stiffness(mesh_of(model), lame_parameters(model.material));
  if (softening == SpinSoftening::kIncluded) K += softening_matrix(model, w);
  const Eigen::Index unknowns = K.rows();
  Eigen::VectorXd f = Eigen::VectorXd::Zero(unknowns + 6);
  Eigen::MatrixXd held = rigid_motions(model.mesh.nodes, model.mesh.node_mass);
  for (Eigen::Index i = 0; i < model.mesh.nodes.rows(); ++i) {
    const Vector3 X = model.mesh.nodes.row(i).transpose();
    f.segment<3>(3 * i) = -model.mesh.node_mass(i) * w.cross(w.cross(X));
    held.middleRows<3>(3 * i) *= model.mesh.node_mass(i);
  }
  // The multipliers are the rigid acceleration that takes up what is left of the load.
  const Eigen::SparseLU<SparseMatrix> solver(bordered(K, held));
  const Eigen::VectorXd u = solver.solve(f).head(unknowns);
  return at_surface(model, Eigen::Map<const Points>(u.data(), unknowns / 3, 3));
}

std::vector<SpinningState> corotational_spin(const Model& model, const Vector3& w, int steps,
                                             int parts) {
  const SoftBody body(mesh_of(model), model.material, Elasticity::kCorotational);
  ImplicitMidpoint rule(body);
  const double h = model.dt / parts;
  rule.prepare(h);
  ImplicitMidpoint::Workspace workspace;
  BodyState state = body.at_rest();
  for (int i = 0; i < body.node_count(); ++i) {
    state.v.segment<3>(3 * i) = w.cross(Vector3(body.rest().row(i).transpose()));
  }
  const Eigen::VectorXd no_force = Eigen::VectorXd::Zero(state.u.size());
  std::vector<SpinningState> states;
  for (int k = 0; k < steps; ++k) {
    for (int part = 0; part < parts; ++part) rule.step(state, no_force, h, workspace);
    const Eigen::Map<const Points> u(state.u.data(), body.node_count(), 3);
    const RigidMotion motion =
        extract_rigid_motion(body.rest(), u, body.mass(), RotationWeights::kMass);
    const Points x = body.rest() + u;
    const Vector3 turn = inertia_of(x, body.mass()).llt().solve(body.angular_momentum(state));
    states.push_back({at_surface(model, elastic_part(body.rest(), u, motion)),
                      motion.rotation.transpose() * turn});
  }
  return states;
}

double largest_error(const Points& u, const Points& reference) {
  return (u - reference).rowwise().norm().maxCoeff() / reference.rowwise().norm().maxCoeff();
}

}  // namespace irdm::test
