#include "precompute/modal/dense_columns.hpp"

#include <cblas.h>

#include "precompute/modal/held_responses.hpp"

namespace irdm::precompute {
namespace {

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
      weighted_(steps, shapes_.cols()),
      column_(steps, shapes_.rows()) {}

template <typename Scalar>
const RowMatrix<Scalar>& DenseColumns<Scalar>::column(int b) {
  weighted_ = responses_.array().rowwise() * shapes_.row(b).array();
  multiply_transposed(weighted_, shapes_, column_);
  return column_;
}

template class DenseColumns<float>;
template class DenseColumns<double>;

}  // namespace irdm::precompute
