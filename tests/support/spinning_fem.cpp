#include "tests/support/spinning_fem.hpp"

#include "precompute/dynamics/implicit_midpoint.hpp"
#include "precompute/dynamics/rigid_extraction.hpp"
#include "precompute/fem/assembly.hpp"
#include "tests/support/static_fem.hpp"

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
  SparseMatrix K = stiffness_of(model);
  if (softening == SpinSoftening::kIncluded) K += softening_matrix(model, w);
  Eigen::VectorXd f(K.rows());
  for (Eigen::Index i = 0; i < model.mesh.nodes.rows(); ++i) {
    const Vector3 X = model.mesh.nodes.row(i).transpose();
    f.segment<3>(3 * i) = -model.mesh.node_mass(i) * w.cross(w.cross(X));
  }
  return balanced_displacement(model, K, f);
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
