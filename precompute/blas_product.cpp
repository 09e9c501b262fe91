#include "precompute/blas_product.hpp"

#include <cblas.h>

#include <algorithm>

namespace irdm::precompute {
namespace {

template <typename Scalar>
int leading(const RowMatrix<Scalar>& matrix) {
  return static_cast<int>(std::max<Eigen::Index>(1, matrix.cols()));
}

template <typename Scalar, typename Gemm>
void multiply(const RowMatrix<Scalar>& A, Of a, const RowMatrix<Scalar>& B, Of b,
              RowMatrix<Scalar>& C, bool add, const Gemm& gemm) {
  const bool a_turned = a == Of::kTransposed;
  const bool b_turned = b == Of::kTransposed;
  const Eigen::Index rows = a_turned ? A.cols() : A.rows();
  const Eigen::Index inner = a_turned ? A.rows() : A.cols();
  const Eigen::Index columns = b_turned ? B.rows() : B.cols();
  if (!add) C.resize(rows, columns);
  if (C.size() == 0) return;
  gemm(CblasRowMajor, a_turned ? CblasTrans : CblasNoTrans, b_turned ? CblasTrans : CblasNoTrans,
       static_cast<int>(rows), static_cast<int>(columns), static_cast<int>(inner), Scalar(1),
       A.data(), leading(A), B.data(), leading(B), add ? Scalar(1) : Scalar(0), C.data(),
       leading(C));
}

}  // namespace

void product(const RowMatrix<float>& A, Of a, const RowMatrix<float>& B, Of b, RowMatrix<float>& C,
             bool add) {
  multiply(A, a, B, b, C, add, cblas_sgemm);
}

void product(const RowMatrix<double>& A, Of a, const RowMatrix<double>& B, Of b,
             RowMatrix<double>& C, bool add) {
  multiply(A, a, B, b, C, add, cblas_dgemm);
}

void transposed_blas_product(const RowMatrix<double>& A, const RowMatrix<double>& B,
                             RowMatrix<double>& C) {
  product(A, Of::kItself, B, Of::kTransposed, C);
}

}  // namespace irdm::precompute
