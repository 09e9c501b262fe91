#include "precompute/compress/measured_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/response/compressed_response.hpp"
#include "precompute/check/static_reference.hpp"
#include "precompute/compress/joint_shapes.hpp"

namespace irdm::precompute {
namespace {

constexpr int kMeasuredNodes = 200;
constexpr double kTime = 0.6;  // s

Vector3 path(double t) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return {0.01 * std::min(t / 0.04, 1.0), 0.005 * std::sin(kTurn * 3.0 * t),
          0.005 * std::min(t / 0.1, 1.0) * std::cos(kTurn * 7.0 * t)};
}

Matrix3 block(const RowMatrix<double>& record, Eigen::Index s) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(record.row(s).data());
}

// f[k] = C[0]^-1 (x[k] - sum_{s >= 1} C[s] f[k-s]) with C[s] = R[s] + (s + 1/2) dt^2 G
std::vector<Vector3> holding_force(const RowMatrix<double>& record, const Matrix3& rigid,
                                   double dt) {
  const auto steps =
      static_cast<int>(std::min(static_cast<double>(record.rows()), std::ceil(kTime / dt)));
  const Matrix3 stiffness = (block(record, 0) + rigid).inverse();
  std::vector<Vector3> force;
  for (int k = 0; k < steps; ++k) {
    Vector3 left = path(dt * k);
    for (int s = 1; s <= k; ++s) {
      left -= (block(record, s) + (2.0 * s + 1.0) * rigid) * force[static_cast<std::size_t>(k - s)];
    }
    force.push_back(stiffness * left);
  }
  return force;
}

// Columns of the tail by one product.
RowMatrix<float> tail_column(const CompressedResponse& response, const RowMatrix<float>& tail,
                             int b) {
  const RowMatrix<float> weighted = tail.array().rowwise() * response.shapes.row(b).array();
  RowMatrix<float> column;
  product(weighted, Of::kItself, response.shapes, Of::kTransposed, column);
  return column;
}

RowMatrix<float> column(const CompressedResponse& response, const RowMatrix<float>& tail, int b) {
  const int m = response.fir_steps;
  RowMatrix<float> values(m + tail.rows(), response.shapes.rows());
  for (int a = 0; a < values.cols(); ++a) {
    with_fir(response, a / 3, a % 3, b / 3, b % 3, [&](const auto* numbers, double scale) {
      for (int s = 0; s < m; ++s)
        values(s, a) = static_cast<float>(scale * static_cast<double>(numbers[s]));
    });
  }
  values.bottomRows(tail.rows()) = tail_column(response, tail, b);
  return values;
}

}  // namespace

double held_force_error(const RowMatrix<double>& expected, const RowMatrix<double>& actual,
                        const Matrix3& rigid, double dt) {
  if (!(std::abs(block(expected, 0).determinant()) > 0.0)) return 0.0;
  const std::vector<Vector3> right = holding_force(expected, rigid, dt);
  const std::vector<Vector3> wrong = holding_force(actual, rigid, dt);
  double peak = 0.0;
  double error = 0.0;
  for (std::size_t k = 0; k < right.size(); ++k) {
    peak = std::max(peak, right[k].norm());
    error = std::max(error, (wrong[k] - right[k]).norm());
  }
  return error / peak;
}

CompressionError measure_error(const CompressedResponse& response, const DenseInput& input,
                               const Console& console) {
  const int nodes = input.degrees_of_freedom() / 3;
  const int stride = (nodes + kMeasuredNodes - 1) / kMeasuredNodes;
  const RowMatrix<float> tail =
      tail_responses(response, input.steps() - response.fir_steps).cast<float>();
  CompressionError error;
  double squares = 0.0;
  Progress progress(console, "measuring", nodes);
  for (int node = 0; node < nodes; node += stride) {
    RowMatrix<double> expected(input.steps(), 9);
    RowMatrix<double> actual(input.steps(), 9);
    for (int b = 0; b < 3; ++b) {
      const RowMatrix<float> R = input.column(3 * node + b);
      const RowMatrix<float> C = column(response, tail, 3 * node + b);
      const double size = R.cast<double>().norm();
      const double share = size > 0.0 ? (C - R).cast<double>().norm() / size : 0.0;
      error.displacement = std::max(error.displacement, share);
      squares += share * share;
      ++error.measured_columns;
      for (int a = 0; a < 3; ++a) {
        expected.col(3 * a + b) = R.col(3 * node + a).cast<double>();
        actual.col(3 * a + b) = C.col(3 * node + a).cast<double>();
      }
    }
    const Model& model = input.description();
    const Vector3 x = model.mesh.rest_position(node);
    const Matrix3 rigid = 0.5 * model.dt * model.dt * rigid_mobility(model.body, x, x);
    error.force = std::max(error.force, held_force_error(expected, actual, rigid, model.dt));
    progress.update(std::min(nodes, node + stride));
  }
  error.displacement_rms = std::sqrt(squares / error.measured_columns);
  return error;
}

}  // namespace irdm::precompute
