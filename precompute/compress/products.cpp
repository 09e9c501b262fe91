#include "precompute/compress/products.hpp"

#include <cblas.h>

namespace irdm::precompute {
namespace {

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
       A.data(), static_cast<int>(A.cols()), B.data(), static_cast<int>(B.cols()),
       add ? Scalar(1) : Scalar(0), C.data(), static_cast<int>(C.cols()));
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

}  // namespace irdm::precompute
