#include "tests/support/static_fem.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <vector>

#include "precompute/fem/assembly.hpp"
#include "precompute/fem/rigid_motions.hpp"

namespace irdm::test {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

Points rows_at_surface(const Model& model, const Eigen::VectorXd& u) {
  const Points all = Eigen::Map<const Points>(u.data(), u.size() / 3, 3);
  return all(model.mesh.surface_nodes, Eigen::all);
}

// (A, C; C^T, 0)
Sparse bordered(const Sparse& A, const Eigen::MatrixXd& C) {
  Entries entries;
  for (int k = 0; k < A.outerSize(); ++k) {
    for (Sparse::InnerIterator it(A, k); it; ++it) {
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
  Sparse matrix(n + C.cols(), n + C.cols());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

Sparse stiffness_of(const Model& model) {
  return precompute::assemble_stiffness({model.mesh.nodes, model.mesh.tets, {}}, model.material);
}

// The multipliers are the rigid acceleration that takes up what is left of the load.
Points balanced_displacement(const Model& model, const Sparse& K, const Eigen::VectorXd& load) {
  Eigen::MatrixXd held = precompute::rigid_motions(model.mesh.nodes, model.mesh.node_mass);
  for (Eigen::Index i = 0; i < model.mesh.nodes.rows(); ++i) {
    held.middleRows<3>(3 * i) *= model.mesh.node_mass(i);
  }
  Eigen::VectorXd f = Eigen::VectorXd::Zero(K.rows() + 6);
  f.head(K.rows()) = load;
  const Eigen::SparseLU<Sparse> solver(bordered(K, held));
  const Eigen::VectorXd u = solver.solve(f);
  return rows_at_surface(model, u.head(K.rows()));
}

Points clamped_sag(const Model& model, int axis, const Vector3& gravity) {
  const Points& nodes = model.mesh.nodes;
  const double lowest = nodes.col(axis).minCoeff();
  std::vector<int> number(static_cast<std::size_t>(3 * nodes.rows()), -1);  // among the free
  std::vector<int> free;
  for (int dof = 0; dof < 3 * nodes.rows(); ++dof) {
    if (nodes(dof / 3, axis) < lowest + 1e-9) continue;
    number[static_cast<std::size_t>(dof)] = static_cast<int>(free.size());
    free.push_back(dof);
  }
  const Sparse K = stiffness_of(model);
  Entries entries;
  for (int k = 0; k < K.outerSize(); ++k) {
    for (Sparse::InnerIterator it(K, k); it; ++it) {
      const int i = number[static_cast<std::size_t>(it.row())];
      const int j = number[static_cast<std::size_t>(it.col())];
      if (i >= 0 && j >= 0) entries.emplace_back(i, j, it.value());
    }
  }
  const auto unknowns = static_cast<Eigen::Index>(free.size());
  Sparse of_free(unknowns, unknowns);
  of_free.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Sparse> solver(of_free);
  const Eigen::VectorXd weight = weight_of(model, gravity)(free);
  const Eigen::VectorXd displacement = solver.solve(weight);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * nodes.rows());
  u(free) = displacement;
  return rows_at_surface(model, u);
}

Eigen::VectorXd weight_of(const Model& model, const Vector3& gravity) {
  Eigen::VectorXd weight(3 * model.mesh.nodes.rows());
  for (Eigen::Index i = 0; i < model.mesh.nodes.rows(); ++i) {
    weight.segment<3>(3 * i) = model.mesh.node_mass(i) * gravity;
  }
  return weight;
}

}  // namespace irdm::test
