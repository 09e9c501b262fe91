#include "precompute/parallel/shared_factors.hpp"

#include "common/error.hpp"

namespace irdm::precompute {
namespace {

// What rank 0 says: this, or so many right-hand sides less.
constexpr int kFactorise = -1;

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Matrix = SlepcObject<Mat, MatDestroy>;

}  // namespace

void SharedFactors::factorise(const Eigen::SparseMatrix<double>& matrix) {
  ranks_.first_says(kFactorise);
  factorise_together(Rows(matrix.selfadjointView<Eigen::Lower>()));
}

Eigen::MatrixXd SharedFactors::solve(const Eigen::Ref<const Eigen::MatrixXd>& right) const {
  Eigen::MatrixXd given = right;
  Eigen::MatrixXd solution(right.rows(), right.cols());
  const auto columns = static_cast<int>(right.cols());
  ranks_.first_says(kFactorise - columns);
  solve_together(columns, given.data(), solution.data());
  return solution;
}

void SharedFactors::help(int number) {
  if (number == kFactorise) return factorise_together(Rows(0, 0));
  solve_together(kFactorise - number, nullptr, nullptr);
}

// All rows are rank 0's, and so are right-hand sides and solutions; MUMPS shares out the factors by
// itself.
void SharedFactors::factorise_together(const Rows& own_rows) {
  own_ = static_cast<PetscInt>(own_rows.rows());
  Matrix matrix;
  slepc(MatCreate(PETSC_COMM_WORLD, matrix.out()));
  slepc(MatSetSizes(matrix, own_, own_, PETSC_DETERMINE, PETSC_DETERMINE));
  slepc(MatSetType(matrix, MATAIJ));
  // Of the next two the one that does not fit the number of ranks does nothing.
  slepc(MatSeqAIJSetPreallocationCSR(matrix, own_rows.outerIndexPtr(), own_rows.innerIndexPtr(),
                                     own_rows.valuePtr()));
  slepc(MatMPIAIJSetPreallocationCSR(matrix, own_rows.outerIndexPtr(), own_rows.innerIndexPtr(),
                                     own_rows.valuePtr()));
  slepc(MatSetOption(matrix, MAT_SPD, PETSC_TRUE));
  slepc(MatDestroy(factors_.out()));
  slepc(MatGetFactor(matrix, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, factors_.out()));
  MatFactorInfo defaults;
  slepc(MatFactorInfoInitialize(&defaults));
  slepc(MatCholeskyFactorSymbolic(factors_, matrix, nullptr, &defaults));
  slepc(MatCholeskyFactorNumeric(factors_, matrix, &defaults));
  MatFactorError what = MAT_FACTOR_NOERROR;
  PetscInt negative = 0;  // pivots, but for those of a last block that ScaLAPACK refuses by itself
  slepc(MatFactorGetError(factors_, &what));
  if (what == MAT_FACTOR_NOERROR) slepc(MatMumpsGetInfog(factors_, 12, &negative));
  if (what == MAT_FACTOR_NOERROR && negative == 0) return;
  throw Error("matrix", "is not positive definite, or there is too little memory to factorise it",
              "check the mesh, or give each rank more memory");
}

void SharedFactors::solve_together(int columns, double* right, double* solution) const {
  Matrix given;
  Matrix found;
  const auto make = [&](double* values, Matrix& matrix) {
    slepc(MatCreateDense(PETSC_COMM_WORLD, own_, PETSC_DECIDE, PETSC_DETERMINE, columns, values,
                         matrix.out()));
    slepc(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    slepc(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  };
  make(right, given);
  make(solution, found);
  slepc(MatMatSolve(factors_, given, found));
}

}  // namespace irdm::precompute
