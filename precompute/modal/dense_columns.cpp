#include "precompute/modal/dense_columns.hpp"

#include <cblas.h>

#include "precompute/modal/held_responses.hpp"

namespace irdm::precompute {
namespace {

constexpr int kColumnsAtOnce = 8;

// c = a b^T, all with contiguous rows.
void multiply_transposed(const RowMatrix<float>& a, const RowMatrix<float>& b,
                         RowMatrix<float>& c) {
  cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, static_cast<int>(a.rows()),
              static_cast<int>(b.rows()), static_cast<int>(a.cols()), 1.0F, a.data(),
              static_cast<int>(a.cols()), b.data(), static_cast<int>(b.cols()), 0.0F, c.data(),
              static_cast<int>(c.cols()));
}
void multiply_transposed(const RowMatrix<double>& a, const RowMatrix<double>& b,
                         RowMatrix<double>& c) {
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, static_cast<int>(a.rows()),
              static_cast<int>(b.rows()), static_cast<int>(a.cols()), 1.0, a.data(),
              static_cast<int>(a.cols()), b.data(), static_cast<int>(b.cols()), 0.0, c.data(),
              static_cast<int>(c.cols()));
}

}  // namespace

template <typename Scalar>
DenseColumns<Scalar>::DenseColumns(const ModalResponse& response, double dt, int steps)
    : shapes_(std::get<RowMatrix<double>>(response.shapes).template cast<Scalar>()),
      responses_(held_responses(response, dt, steps).cast<Scalar>()),
      block_size_(limited_block_size(kColumnsAtOnce, steps, static_cast<int>(shapes_.rows()),
                                     sizeof(Scalar))) {}

template <typename Scalar>
Columns DenseColumns<Scalar>::block(int k) const {
  const ColumnRange range = block_range(k);
  const Eigen::Index steps = responses_.rows();
  RowMatrix<Scalar> weighted(range.count() * steps, shapes_.cols());  // h diag(Phi_b)
  for (int b = range.begin; b < range.end; ++b) {
    weighted.middleRows((b - range.begin) * steps, steps) =
        responses_.array().rowwise() * shapes_.row(b).array();
  }
  RowMatrix<Scalar> columns(weighted.rows(), shapes_.rows());
  multiply_transposed(weighted, shapes_, columns);
  return columns;
}

template <typename Scalar>
RowMatrix<Scalar> DenseColumns<Scalar>::column(int b) const {
  const int k = b / block_size_;
  const Eigen::Index steps = responses_.rows();
  return std::get<RowMatrix<Scalar>>(block(k)).middleRows((b - k * block_size_) * steps, steps);
}

template class DenseColumns<float>;
template class DenseColumns<double>;

}  // namespace irdm::precompute
