#include "precompute/check/columns.hpp"

#include <cblas.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/error.hpp"
#include "common/model/model_writer.hpp"
#include "common/response/compressed_response.hpp"
#include "precompute/modal/elastic_statics.hpp"

namespace irdm::precompute {
namespace {

constexpr double kNegligible = 1e-6;
constexpr double kLongestRecord = 4096;

// a b^T
RowMatrix<double> product_transposed(const RowMatrix<double>& a, const RowMatrix<double>& b) {
  RowMatrix<double> c(a.rows(), b.rows());
  cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, static_cast<int>(a.rows()),
              static_cast<int>(b.rows()), static_cast<int>(a.cols()), 1.0, a.data(),
              static_cast<int>(a.cols()), b.data(), static_cast<int>(b.cols()), 0.0, c.data(),
              static_cast<int>(c.cols()));
  return c;
}

/// @param decay of the slowest part, its logarithm a step
RecordLength length_for(double decay) {
  const double decades = -std::log(kNegligible);
  const double needed = std::ceil(decades / decay);
  if (needed <= kLongestRecord) return {static_cast<int>(std::max(needed, 2.0)), 1.0};
  return {static_cast<int>(kLongestRecord),
          std::exp(-(decades - decay * kLongestRecord) / kLongestRecord)};
}

}  // namespace

RowMatrix<double> ModalColumns::column(int b, int steps) const {
  const RowMatrix<double> weighted =
      held_responses(response_, dt_, steps).array().rowwise() * shapes().row(b).array();
  RowMatrix<double> column = product_transposed(weighted, shapes());
  column.row(0) += residual(b).transpose();
  return column;
}

// What modes that are left out do at once, (3n).
Eigen::VectorXd ModalColumns::residual(int b) const {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(shapes().rows());
  const ResidualCompliance& g = response_.residual;
  if (g.empty()) return u;
  const auto node = static_cast<std::size_t>(b / 3);
  for (int k = g.row_start[node]; k < g.row_start[node + 1]; ++k) {
    const auto place = static_cast<std::size_t>(k);
    for (int axis = 0; axis < 3; ++axis) {
      u(3 * g.nodes[place] + axis) =
          static_cast<double>(g.blocks[9 * place + static_cast<std::size_t>(3 * (b % 3) + axis)]);
    }
  }
  return u;
}

Eigen::VectorXd ModalColumns::settled(int b) const {
  const Eigen::ArrayXd omega = response_.angular_frequency;
  return shapes() * (shapes().row(b).transpose().array() / omega.square()).matrix() + residual(b);
}

std::vector<int> ModalColumns::complete_nodes(int b) const {
  const ResidualCompliance& g = response_.residual;
  if (g.empty()) {
    std::vector<int> all(static_cast<std::size_t>(shapes().rows() / 3));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  const auto row = g.row_start.begin() + b / 3;
  return {g.nodes.begin() + row[0], g.nodes.begin() + row[1]};
}

StoredColumns::StoredColumns(const std::filesystem::path& path, int degrees_of_freedom, int steps)
    : file_(hdf5::File::open(path)), degrees_of_freedom_(degrees_of_freedom), steps_(steps) {
  const auto dof = static_cast<hsize_t>(degrees_of_freedom);
  if (file_.shape(kDenseR) != hdf5::Shape({dof, static_cast<hsize_t>(steps), dof})) {
    throw Error(path.string(), "/response/dense/R must have the shape (3n, steps, 3n)",
                "make the model again with irdm-precompute");
  }
}

RowMatrix<double> StoredColumns::column(int b, int steps) const {
  RowMatrix<double> values(steps, degrees_of_freedom_);
  file_.read_slab<double>(
      kDenseR, {static_cast<hsize_t>(b), 0, 0},
      {1, static_cast<hsize_t>(steps), static_cast<hsize_t>(degrees_of_freedom_)}, values.data());
  return values;
}

Eigen::VectorXd StoredColumns::settled(int b) const {
  return column(b, steps_).colwise().sum().transpose();
}

bool StoredColumns::has_checksums() const {
  return file_.has_filter(kDenseR, H5Z_FILTER_FLETCHER32);
}

RowMatrix<double> CompressedColumns::column(int b, int steps) const {
  const int tail = std::max(0, steps - response_.fir_steps);
  return compressed_column(response_, tail_responses(response_, tail), b, steps);
}

Eigen::VectorXd CompressedColumns::settled(int b) const {
  const RowMatrix<double> none(0, response_.shape_count());
  const Eigen::VectorXd fir =
      compressed_column(response_, none, b, response_.fir_steps).colwise().sum().transpose();
  const Eigen::VectorXd weighted = settled_tail_responses(response_).cwiseProduct(
      response_.shapes.row(b).cast<double>().transpose());
  return fir + response_.shapes.cast<double>() * weighted;
}

DrivingPoint CompressedColumns::driving_point(int node, const RowMatrix<double>& tail) const {
  const int m = response_.fir_steps;
  DrivingPoint record(9, m + tail.rows());
  const RowMatrix<double> rows = response_.shapes.middleRows(3 * node, 3).cast<double>();
  for (int entry = 0; entry < 9; ++entry) {
    const int a = entry % 3;
    const int b = entry / 3;
    for (int s = 0; s < m; ++s) record(entry, s) = fir_response(response_, node, a, node, b, s);
    const Eigen::VectorXd product = rows.row(a).cwiseProduct(rows.row(b)).transpose();
    record.row(entry).tail(tail.rows()) = (tail * product).transpose();
  }
  return record;
}

std::vector<DrivingPoint> modal_driving_points(const ModalResponse& response,
                                               const RowMatrix<double>& held, int first,
                                               int count) {
  const auto& shapes = std::get<RowMatrix<double>>(response.shapes);
  RowMatrix<double> products(9 * count, shapes.cols());
  for (int i = 0; i < count; ++i) {
    for (int entry = 0; entry < 9; ++entry) {
      products.row(9 * i + entry) = shapes.row(3 * (first + i) + entry % 3)
                                        .cwiseProduct(shapes.row(3 * (first + i) + entry / 3));
    }
  }
  const RowMatrix<double> records = product_transposed(products, held);
  std::vector<DrivingPoint> points;
  for (int i = 0; i < count; ++i) points.emplace_back(records.middleRows(9 * i, 9));
  if (response.residual.empty()) return points;
  for (int i = 0; i < count; ++i) {
    points[static_cast<std::size_t>(i)].col(0) += response.residual.diagonal(first + i).reshaped();
  }
  return points;
}

RecordLength record_length(const ModalResponse& response, double dt) {
  double slowest = std::numeric_limits<double>::infinity();  // [1/s]
  for (int i = 0; i < response.mode_count(); ++i) {
    const double omega = response.angular_frequency(i);
    const double sigma = response.decay_rate(i);
    const double rate =
        sigma < omega ? sigma : omega * omega / (sigma + std::sqrt(sigma * sigma - omega * omega));
    slowest = std::min(slowest, rate);
  }
  return length_for(slowest * dt);
}

RecordLength record_length(const CompressedResponse& response) {
  const double largest = response.pole_count() == 0 ? 0.0 : response.pole.cwiseAbs().maxCoeff();
  RecordLength length = length_for(-std::log(std::max(largest, 1e-3)));
  length.steps = std::max(length.steps, response.fir_steps + 2);
  return length;
}

}  // namespace irdm::precompute
