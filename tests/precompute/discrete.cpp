#include "tests/precompute/discrete.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>

#include "precompute/fem/rigid_motions.hpp"

namespace irdm::test {

using namespace precompute;

Discrete::Discrete(TetMesh m, const Material& material)
    : mesh(std::move(m)),
      stiffness(assemble_stiffness(mesh, material)),
      mass(lumped_mass(mesh, material)),
      mass3(mass.replicate(1, 3).transpose().reshaped()),
      rigid(rigid_motions(mesh.nodes, mass)) {}

Eigen::MatrixXd Discrete::without_rigid(const Eigen::MatrixXd& u) const {
  return u - rigid * (rigid.transpose() * mass3.asDiagonal() * u);
}

int node_at(const TetMesh& mesh, const Vector3& x) {
  Eigen::Index node = 0;
  (mesh.nodes.rowwise() - x.transpose()).rowwise().squaredNorm().minCoeff(&node);
  return static_cast<int>(node);
}

Eigen::VectorXd inertia_relief(const Discrete& body, const Eigen::VectorXd& force, int a, int b,
                               int c) {
  SparseMatrix held = body.stiffness;
  const double large = 1e3 * Eigen::VectorXd(held.diagonal()).maxCoeff();
  for (const int dof : {3 * a, 3 * a + 1, 3 * a + 2, 3 * b + 1, 3 * b + 2, 3 * c + 2}) {
    held.coeffRef(dof, dof) += large;
  }
  const Eigen::VectorXd balanced =
      force - body.mass3.asDiagonal() * (body.rigid * (body.rigid.transpose() * force));
  const Eigen::SimplicialLDLT<SparseMatrix> solver(held);
  return body.without_rigid(solver.solve(balanced));
}

Eigen::VectorXd lowest_eigenvalues(const Discrete& body, double shift, int block, int rounds) {
  SparseMatrix shifted = body.stiffness;
  for (Eigen::Index i = 0; i < body.mass3.size(); ++i) {
    shifted.coeffRef(i, i) += shift * body.mass3(i);
  }
  const Eigen::SimplicialLDLT<SparseMatrix> solver(shifted);
  std::srand(1);
  Eigen::MatrixXd x = Eigen::MatrixXd::Random(body.mass3.size(), block);
  Eigen::VectorXd values;
  for (int round = 0; round < rounds; ++round) {
    x = body.without_rigid(solver.solve(body.mass3.asDiagonal() * x));
    const Eigen::MatrixXd k = x.transpose() * (body.stiffness * x);
    const Eigen::MatrixXd m = x.transpose() * body.mass3.asDiagonal() * x;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(k, m);
    x = Eigen::MatrixXd(x * ritz.eigenvectors());
    values = ritz.eigenvalues();
  }
  return values;
}

double lowest_frequency(const Discrete& body, double shift) {
  return std::sqrt(lowest_eigenvalues(body, shift, 12, 12)(0)) / (2.0 * std::numbers::pi);
}

}  // namespace irdm::test
