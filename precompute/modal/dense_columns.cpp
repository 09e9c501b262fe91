#include "precompute/modal/dense_columns.hpp"

#include <algorithm>
#include <limits>

#include "common/response/modal_response.hpp"
#include "precompute/blas.hpp"

namespace irdm::precompute {
namespace {

constexpr int kDenseColumnsAtOnce = 8;
constexpr Eigen::Index kStepsAtOnce = 32;

// How many modes to keep so that the others add up to at most `share` of all, where mode i counts
// with bound(i).
int needed_modes(const Eigen::VectorXd& bound, double share) {
  const double negligible = share * bound.sum();
  double dropped = 0.0;
  Eigen::Index kept = bound.size();
  while (kept > 1 && dropped + bound(kept - 1) <= negligible) dropped += bound(--kept);
  return static_cast<int>(kept);
}

// For each group of steps, the largest number that one of its steps needs.
std::vector<int> needed_modes(const RowMatrix<double>& shapes, const RowMatrix<double>& responses,
                              double share) {
  const Eigen::RowVectorXd largest = shapes.cwiseAbs2().colwise().maxCoeff();
  std::vector<int> modes;
  for (Eigen::Index s = 0; s < responses.rows(); ++s) {
    if (s % kStepsAtOnce == 0) modes.push_back(1);
    const Eigen::VectorXd bound = responses.row(s).cwiseAbs().cwiseProduct(largest);
    modes.back() = std::max(modes.back(), needed_modes(bound, share));
  }
  return modes;
}

}  // namespace

template <typename Scalar>
DenseColumns<Scalar>::DenseColumns(const ModalResponse& response, double dt, int steps) {
  const auto& shapes = std::get<RowMatrix<double>>(response.shapes);
  const RowMatrix<double> responses = held_responses(response, dt, steps);
  shapes_ = shapes.template cast<Scalar>();
  responses_ = responses.template cast<Scalar>();
  centrifugal_ = response.centrifugal.transpose().template cast<Scalar>();
  if (response.gravity.rows() > 0) {
    gravity_ = response.gravity.transpose().template cast<Scalar>();
  }
  block_size_ = limited_block_size(kDenseColumnsAtOnce, steps, columns(), sizeof(Scalar));
  constexpr double kEpsilon = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
  modes_ = needed_modes(shapes, responses, kEpsilon / 8.0);
}

template <typename Scalar>
int DenseColumns<Scalar>::modes_at(int s) const {
  return modes_[static_cast<std::size_t>(s / kStepsAtOnce)];
}

// Phi diag(h[s]) of each row of the modal loads, rows [load][s].
template <typename Scalar>
RowMatrix<Scalar> DenseColumns<Scalar>::weighted_columns(const RowMatrix<Scalar>& loads) const {
  const Eigen::Index steps = responses_.rows();
  RowMatrix<Scalar> columns(loads.rows() * steps, shapes_.rows());
  for (Eigen::Index s = 0; s < steps; s += kStepsAtOnce) {
    const Eigen::Index count = std::min(kStepsAtOnce, steps - s);
    const Eigen::Index modes = modes_at(static_cast<int>(s));
    RowMatrix<Scalar> weighted(loads.rows() * count, modes);  // h diag(load), rows [load][s]
    for (Eigen::Index b = 0; b < loads.rows(); ++b) {
      weighted.middleRows(b * count, count) =
          responses_.block(s, 0, count, modes).array().rowwise() * loads.row(b).head(modes).array();
    }
    RowMatrix<Scalar> part;
    product(weighted, Of::kItself, shapes_, Of::kTransposed, part);
    for (Eigen::Index b = 0; b < loads.rows(); ++b) {
      columns.middleRows(b * steps + s, count) = part.middleRows(b * count, count);
    }
  }
  return columns;
}

template <typename Scalar>
Columns DenseColumns<Scalar>::block(int k) const {
  const ColumnRange range = block_range(k);
  return weighted_columns(shapes_.middleRows(range.begin, range.count()));
}

template <typename Scalar>
Columns DenseColumns<Scalar>::centrifugal() const {
  return weighted_columns(centrifugal_);
}

// What sets in and stays is held in every step from then on.
template <typename Scalar>
Columns DenseColumns<Scalar>::gravity() const {
  RowMatrix<Scalar> columns = weighted_columns(gravity_);
  for (Eigen::Index first = 0; first < columns.rows(); first += responses_.rows()) {
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(columns.cols());
    for (Eigen::Index s = first; s < first + responses_.rows(); ++s) {
      sum += columns.row(s).template cast<double>();
      columns.row(s) = sum.template cast<Scalar>();
    }
  }
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
