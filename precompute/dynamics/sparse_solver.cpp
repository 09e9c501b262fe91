#include "precompute/dynamics/sparse_solver.hpp"

#include <Eigen/SparseCholesky>

#include "common/error.hpp"

namespace irdm::precompute {

Eigen::SparseMatrix<double> step_matrix(const SoftBody& body,
                                        const Eigen::SparseMatrix<double>& stiffness, double h) {
  Eigen::SparseMatrix<double> sum = (0.5 * h + body.rayleigh_beta()) * stiffness;
  const double factor = 2.0 / h + body.rayleigh_alpha();
  for (Eigen::Index i = 0; i < stiffness.rows(); ++i) {
    sum.coeffRef(i, i) += factor * body.mass()(i / 3);
  }
  return sum;
}

namespace {

class EigenSolver final : public SparseSolver {
 public:
  void factorise(const Eigen::SparseMatrix<double>& matrix) override {
    if (!analysed_) ldlt_.analyzePattern(matrix);
    analysed_ = true;
    ldlt_.factorize(matrix);
    if (ldlt_.info() != Eigen::Success || !(ldlt_.vectorD().minCoeff() > 0.0)) {
      throw Error("time stepping", "the matrix of a step is not positive definite",
                  "check the mesh for extremely distorted elements, or use smaller steps");
    }
  }
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& right) const override {
    return ldlt_.solve(right);
  }

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt_;
  bool analysed_ = false;
};

}  // namespace

std::unique_ptr<SparseSolver> make_eigen_solver() {
  return std::make_unique<EigenSolver>();
}

#ifndef IRDM_WITH_CHOLMOD  // else in cholmod_solver.cpp
std::unique_ptr<SparseSolver> make_sparse_solver() {
  return make_eigen_solver();
}
const char* sparse_solver_name() {
  return "Eigen";
}
#endif

}  // namespace irdm::precompute
