#include "common/response/stored_response.hpp"

#include <algorithm>
#include <limits>

#include "common/error.hpp"
#include "common/hdf5/file.hpp"
#include "common/model/content_checksum.hpp"
#include "common/model/model_writer.hpp"
#include "common/response/compressed_response.hpp"
#include "common/response/modal_response.hpp"

namespace irdm {
namespace {

const RowMatrix<double>& in_double(const RowMatrix<double>& matrix) {
  return matrix;
}
RowMatrix<double> in_double(const RowMatrix<float>& matrix) {
  return matrix.cast<double>();
}

// Rows 3 b + a: the products of a node's rows a and b of all shapes.
template <typename Rows>
void outer_products(const Rows& rows, Eigen::Ref<RowMatrix<double>> products) {
  for (int entry = 0; entry < 9; ++entry) {
    products.row(entry) = rows.row(entry % 3).cwiseProduct(rows.row(entry / 3));
  }
}

template <typename Scalar>
class ModalStored final : public StoredResponse {
 public:
  ModalStored(const ModalResponse& response, const RowMatrix<Scalar>& shapes, double dt,
              TransposedProduct product)
      : response_(response), shapes_(shapes), dt_(dt), product_(product) {}

  RowMatrix<double> column(int b, int steps) const override {
    const RowMatrix<double> weighted =
        held_responses(response_, dt_, steps).array().rowwise() * row(b).transpose().array();
    RowMatrix<double> column;
    product_(weighted, in_double(shapes_), column);
    column.row(0) += residual(b).transpose();
    return column;
  }

  Eigen::VectorXd static_column(int b) const override {
    const Eigen::VectorXd settled = row(b).cwiseQuotient(response_.angular_frequency.cwiseAbs2());
    return in_double(shapes_) * settled + residual(b);
  }

  Eigen::VectorXd static_compliance(const Eigen::SparseMatrix<double>& loads) const override {
    Eigen::VectorXd values(loads.cols());
    Eigen::VectorXd load(loads.rows());
    for (Eigen::Index a = 0; a < loads.cols(); ++a) {
      Eigen::VectorXd driven = Eigen::VectorXd::Zero(shapes_.cols());
      for (Eigen::SparseMatrix<double>::InnerIterator it(loads, a); it; ++it) {
        driven += it.value() * row(static_cast<int>(it.row()));
      }
      load = loads.col(a);
      values(a) = driven.cwiseQuotient(response_.angular_frequency).squaredNorm() +
                  residual_work(loads, a, load);
    }
    return values;
  }

  std::vector<DrivingPoint> driving_points(int first, int count, int steps) const override {
    RowMatrix<double> products(9 * count, shapes_.cols());
    for (int i = 0; i < count; ++i) {
      outer_products(in_double(shapes_.middleRows(3 * (first + i), 3).eval()),
                     products.middleRows(9 * i, 9));
    }
    RowMatrix<double> records;
    product_(products, held_responses(response_, dt_, steps), records);
    std::vector<DrivingPoint> blocks;
    for (int i = 0; i < count; ++i) {
      blocks.emplace_back(records.middleRows(9 * i, 9));
      if (response_.residual.empty()) continue;
      blocks.back().col(0) += response_.residual.diagonal(first + i).reshaped();
    }
    return blocks;
  }

  Eigen::MatrixXd zero_lag() const override {
    return weighted(held_responses(response_, dt_, 1).row(0).transpose().cwiseMax(0.0));
  }

  Eigen::MatrixXd static_limit() const override {
    return weighted(response_.angular_frequency.cwiseAbs2().cwiseInverse());
  }

 private:
  // Returns Phi diag(weights) Phi^T plus the residual. @param weights >= 0
  Eigen::MatrixXd weighted(const Eigen::VectorXd& weights) const {
    const Eigen::MatrixXd root = shapes_.template cast<double>() * weights.cwiseSqrt().asDiagonal();
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(root.rows(), root.rows());
    R.selfadjointView<Eigen::Lower>().rankUpdate(root);
    R = Eigen::MatrixXd(R.selfadjointView<Eigen::Lower>());
    const ResidualCompliance& g = response_.residual;
    for (int i = 0; i + 1 < static_cast<int>(g.row_start.size()); ++i) {
      for (int k = g.begin_of(i); k < g.end_of(i); ++k) {
        R.block<3, 3>(3 * i, 3 * g.nodes[static_cast<std::size_t>(k)]) +=
            g.block(k).template cast<double>();
      }
    }
    return R;
  }

  Eigen::VectorXd row(int b) const { return shapes_.row(b).transpose().template cast<double>(); }

  // What modes that are left out do at once, (3n): the blocks of b's node, transposed.
  Eigen::VectorXd residual(int b) const {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(shapes_.rows());
    const ResidualCompliance& g = response_.residual;
    if (g.empty()) return u;
    for (int k = g.begin_of(b / 3); k < g.end_of(b / 3); ++k) {
      u.segment<3>(3 * g.nodes[static_cast<std::size_t>(k)]) =
          g.block(k).row(b % 3).transpose().template cast<double>();
    }
    return u;
  }

  // Of load a, which is `load` as well, with itself [m/N].
  double residual_work(const Eigen::SparseMatrix<double>& loads, Eigen::Index a,
                       const Eigen::VectorXd& load) const {
    const ResidualCompliance& g = response_.residual;
    if (g.empty()) return 0.0;
    double work = 0.0;
    for (Eigen::SparseMatrix<double>::InnerIterator it(loads, a); it; ++it) {
      const auto b = static_cast<int>(it.row());
      for (int k = g.begin_of(b / 3); k < g.end_of(b / 3); ++k) {
        const int other = g.nodes[static_cast<std::size_t>(k)];
        work += it.value() *
                g.block(k).row(b % 3).template cast<double>().dot(load.segment<3>(3 * other));
      }
    }
    return work;
  }

  const ModalResponse& response_;
  const RowMatrix<Scalar>& shapes_;
  double dt_;
  TransposedProduct product_;
};

template <typename Scalar>
class DenseStored final : public StoredResponse {
 public:
  DenseStored(const DenseResponse& response, const std::vector<Scalar>& values)
      : dof_(response.degrees_of_freedom), values_(values.data(), dof_ * dof_, response.steps) {}

  RowMatrix<double> column(int b, int steps) const override {
    return values_.block(b * dof_, 0, dof_, steps).transpose().template cast<double>();
  }
  Eigen::VectorXd static_column(int b) const override {
    return values_.middleRows(b * dof_, dof_).template cast<double>().rowwise().sum();
  }
  Eigen::MatrixXd zero_lag() const override {
    return values_.col(0).template cast<double>().reshaped(dof_, dof_);
  }

 private:
  Eigen::Index dof_;
  Eigen::Map<const RowMatrix<Scalar>> values_;  ///< row b 3n + a: (a, b) of all steps
};

template <typename Scalar>
class StreamedStored final : public StoredResponse {
 public:
  StreamedStored(const StreamedResponse& response, const std::vector<Scalar>& first)
      : first_(first.data(), response.degrees_of_freedom, response.degrees_of_freedom),
        rest_(response.rest.data(), response.degrees_of_freedom, response.degrees_of_freedom),
        settling_(response.settling.data(), static_cast<Eigen::Index>(response.settling.size())) {}

  RowMatrix<double> column(int b, int steps) const override {
    RowMatrix<double> column =
        settling_.head(steps) * rest_.col(b).transpose().template cast<double>();
    column.row(0) = first_.col(b).transpose().template cast<double>();
    return column;
  }
  Eigen::VectorXd static_column(int b) const override {
    return first_.col(b).template cast<double>() + rest_.col(b).template cast<double>();
  }
  Eigen::MatrixXd zero_lag() const override { return first_.template cast<double>(); }

 private:
  Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>> first_;
  Eigen::Map<const Eigen::MatrixXf> rest_;
  Eigen::Map<const Eigen::VectorXd> settling_;
};

class CompressedStored final : public StoredResponse {
 public:
  CompressedStored(const CompressedResponse& response, TransposedProduct product)
      : response_(response), product_(product), settled_(settled_tail_responses(response)) {}

  RowMatrix<double> column(int b, int steps) const override {
    const int m = std::min(response_.fir_steps, steps);
    const auto dof = static_cast<int>(response_.shapes.rows());
    RowMatrix<double> column(steps, dof);
    for (int a = 0; a < dof; ++a) {
      with_fir(response_, a / 3, a % 3, b / 3, b % 3, [&](const auto* numbers, double scale) {
        for (int s = 0; s < m; ++s) column(s, a) = scale * static_cast<double>(numbers[s]);
      });
    }
    if (steps == m) return column;
    const RowMatrix<double> weighted =
        tail_responses(response_, steps - m).array().rowwise() * row(b).transpose().array();
    RowMatrix<double> tail;
    product_(weighted, in_double(response_.shapes), tail);
    column.bottomRows(steps - m) = tail;
    return column;
  }

  Eigen::VectorXd static_column(int b) const override {
    return column(b, response_.fir_steps).colwise().sum().transpose() +
           response_.shapes.cast<double>() * row(b).cwiseProduct(settled_);
  }

  std::vector<DrivingPoint> driving_points(int first, int count, int steps) const override {
    const int m = response_.fir_steps;
    RowMatrix<double> products(9 * count, response_.shapes.cols());
    for (int i = 0; i < count; ++i) {
      outer_products(in_double(response_.shapes.middleRows(3 * (first + i), 3).eval()),
                     products.middleRows(9 * i, 9));
    }
    RowMatrix<double> tail;
    product_(products, tail_responses(response_, steps - m), tail);
    std::vector<DrivingPoint> blocks;
    for (int i = 0; i < count; ++i) {
      DrivingPoint& record = blocks.emplace_back(9, steps);
      record.leftCols(m) = fir_blocks(first + i);
      record.rightCols(steps - m) = tail.middleRows(9 * i, 9);
    }
    return blocks;
  }

  Eigen::MatrixXd zero_lag() const override {
    const Eigen::Index dof = response_.shapes.rows();
    Eigen::MatrixXd R(dof, dof);
    for (int b = 0; b < dof; ++b) R.col(b) = column(b, 1).transpose();
    return R;
  }

 private:
  Eigen::VectorXd row(int b) const { return response_.shapes.row(b).transpose().cast<double>(); }

  DrivingPoint fir_blocks(int node) const {
    DrivingPoint record(9, response_.fir_steps);
    for (int entry = 0; entry < 9; ++entry) {
      for (int s = 0; s < response_.fir_steps; ++s) {
        record(entry, s) = fir_response(response_, node, entry % 3, node, entry / 3, s);
      }
    }
    return record;
  }

  const CompressedResponse& response_;
  TransposedProduct product_;
  Eigen::VectorXd settled_;  ///< sum over s >= m of h_i[s] (r)
};

/// Of a rigid body.
class ZeroStored final : public StoredResponse {
 public:
  explicit ZeroStored(int degrees_of_freedom) : dof_(degrees_of_freedom) {}

  RowMatrix<double> column(int, int steps) const override {
    return RowMatrix<double>::Zero(steps, dof_);
  }
  Eigen::VectorXd static_column(int) const override { return Eigen::VectorXd::Zero(dof_); }
  Eigen::MatrixXd zero_lag() const override { return Eigen::MatrixXd::Zero(dof_, dof_); }

 private:
  int dof_;
};

class DenseInFile final : public StoredResponse {
 public:
  DenseInFile(const std::filesystem::path& path, int degrees_of_freedom, int steps)
      : file_(hdf5::File::open(path)),
        checksums_(file_, static_cast<std::size_t>(degrees_of_freedom)),
        single_(file_.element_size(kDenseR) == sizeof(float)),
        dof_(degrees_of_freedom),
        steps_(steps) {
    const auto dof = static_cast<hsize_t>(degrees_of_freedom);
    if (file_.stored_shape(kDenseR) != hdf5::Shape({dof, static_cast<hsize_t>(steps), dof})) {
      throw Error(path.string(), "/response/dense/R must have the shape (3n, steps, 3n)",
                  "make the model again with irdm-precompute");
    }
  }

  RowMatrix<double> column(int b, int steps) const override {
    RowMatrix<double> values(steps, dof_);
    file_.read_slab<double>(kDenseR, {static_cast<hsize_t>(b), 0, 0},
                            {1, static_cast<hsize_t>(steps), static_cast<hsize_t>(dof_)},
                            values.data());
    if (steps == steps_) compare(static_cast<std::size_t>(b), values);
    return values;
  }
  Eigen::VectorXd static_column(int b) const override {
    return column(b, steps_).colwise().sum().transpose();
  }
  Eigen::MatrixXd zero_lag() const override {
    Eigen::MatrixXd R(dof_, dof_);
    for (int b = 0; b < dof_; ++b) R.col(b) = column(b, 1).transpose();
    return R;
  }

 private:
  // As the numbers stand in the file.
  void compare(std::size_t b, const RowMatrix<double>& column) const {
    const auto count = static_cast<std::size_t>(column.size());
    if (single_) {
      const RowMatrix<float> stored = column.cast<float>();
      checksums_.compare(b, stored.data(), count);
    } else {
      checksums_.compare(b, column.data(), count);
    }
  }

  hdf5::File file_;
  ColumnChecksums checksums_;
  bool single_;  ///< the file's numbers are in single precision
  int dof_;
  int steps_;
};

}  // namespace

void transposed_product(const RowMatrix<double>& a, const RowMatrix<double>& b,
                        RowMatrix<double>& c) {
  c.noalias() = a * b.transpose();
}

Eigen::MatrixXd StoredResponse::static_limit() const {
  Eigen::MatrixXd limit;
  for (int b = 0; b == 0 || b < static_cast<int>(limit.cols()); ++b) {
    const Eigen::VectorXd column = static_column(b);
    if (b == 0) limit.resize(column.size(), column.size());
    limit.col(b) = column;
  }
  return limit;
}

// Each column is summed up once, whatever loads it belongs to.
Eigen::VectorXd StoredResponse::static_compliance(const Eigen::SparseMatrix<double>& loads) const {
  const Eigen::SparseMatrix<double, Eigen::RowMajor> by_row = loads;
  Eigen::VectorXd values = Eigen::VectorXd::Zero(loads.cols());
  for (Eigen::Index b = 0; b < by_row.rows(); ++b) {
    Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(by_row, b);
    if (!it) continue;
    const Eigen::VectorXd column = static_column(static_cast<int>(b));
    for (; it; ++it) values(it.col()) += it.value() * loads.col(it.col()).dot(column);
  }
  return values;
}

std::vector<DrivingPoint> StoredResponse::driving_points(int first, int count, int steps) const {
  std::vector<DrivingPoint> blocks;
  for (int node = first; node < first + count; ++node) {
    DrivingPoint& record = blocks.emplace_back(9, steps);
    for (int b = 0; b < 3; ++b) {
      record.middleRows<3>(3 * b) = column(3 * node + b, steps).middleCols<3>(3 * node).transpose();
    }
  }
  return blocks;
}

std::unique_ptr<StoredResponse> stored_response(const ModalResponse& response, double dt,
                                                TransposedProduct product) {
  return std::visit(
      [&]<typename Scalar>(const RowMatrix<Scalar>& shapes) -> std::unique_ptr<StoredResponse> {
        return std::make_unique<ModalStored<Scalar>>(response, shapes, dt, product);
      },
      response.shapes);
}

std::unique_ptr<StoredResponse> stored_response(const CompressedResponse& response,
                                                TransposedProduct product) {
  return std::make_unique<CompressedStored>(response, product);
}

std::unique_ptr<StoredResponse> stored_response(const std::filesystem::path& path,
                                                int degrees_of_freedom, int steps) {
  return std::make_unique<DenseInFile>(path, degrees_of_freedom, steps);
}

std::unique_ptr<StoredResponse> stored_response(const Model& model, TransposedProduct product) {
  if (const auto* modal = std::get_if<ModalResponse>(&model.response)) {
    return stored_response(*modal, model.dt, product);
  }
  if (const auto* compressed = std::get_if<CompressedResponse>(&model.response)) {
    return stored_response(*compressed, product);
  }
  if (const auto* dense = std::get_if<DenseResponse>(&model.response)) {
    return std::visit(
        [&]<typename Scalar>(const std::vector<Scalar>& values) -> std::unique_ptr<StoredResponse> {
          return std::make_unique<DenseStored<Scalar>>(*dense, values);
        },
        dense->values);
  }
  if (is_rigid(model)) return std::make_unique<ZeroStored>(model.degrees_of_freedom());
  const auto& streamed = std::get<StreamedResponse>(model.response);
  return std::visit(
      [&]<typename Scalar>(const std::vector<Scalar>& first) -> std::unique_ptr<StoredResponse> {
        return std::make_unique<StreamedStored<Scalar>>(streamed, first);
      },
      streamed.first);
}

Eigen::VectorXd static_compliance(const Model& model, const Eigen::SparseMatrix<double>& loads) {
  if (std::holds_alternative<std::monostate>(model.response)) {
    return Eigen::VectorXd::Constant(loads.cols(), std::numeric_limits<double>::quiet_NaN());
  }
  return stored_response(model)->static_compliance(loads);
}

}  // namespace irdm
