#include "common/dense_algebra.hpp"

#include <Eigen/Dense>

namespace irdm {
namespace {

using SymmetricSolver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

}  // namespace

SymmetricEigen symmetric_eigenpairs(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  const SymmetricSolver solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  return SymmetricSolver(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

SymmetricEigen tridiagonal_eigenpairs(const Eigen::VectorXd& diagonal,
                                      const Eigen::VectorXd& off_diagonal) {
  SymmetricSolver solver;
  solver.computeFromTridiagonal(diagonal, off_diagonal);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXcd eigenvalues(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
}

Eigen::MatrixXd least_squares(const Eigen::Ref<const Eigen::MatrixXd>& A,
                              const Eigen::Ref<const Eigen::MatrixXd>& B) {
  return Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(A).solve(B);
}

Eigen::MatrixXd solve_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& A,
                                const Eigen::Ref<const Eigen::MatrixXd>& B) {
  return Eigen::LDLT<Eigen::MatrixXd>(A).solve(B);
}

Eigen::MatrixXd solve_square(const Eigen::Ref<const Eigen::MatrixXd>& A,
                             const Eigen::Ref<const Eigen::MatrixXd>& B) {
  return Eigen::PartialPivLU<Eigen::MatrixXd>(A).solve(B);
}

}  // namespace irdm
