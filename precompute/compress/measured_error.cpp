#include "precompute/compress/measured_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/response/stored_response.hpp"
#include "precompute/blas.hpp"
#include "precompute/check/static_reference.hpp"

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
  const auto compressed = stored_response(response, transposed_blas_product);
  CompressionError error;
  double squares = 0.0;
  Progress progress(console, "measuring", nodes);
  for (int node = 0; node < nodes; node += stride) {
    RowMatrix<double> expected(input.steps(), 9);
    RowMatrix<double> actual(input.steps(), 9);
    for (int b = 0; b < 3; ++b) {
      const RowMatrix<double> R = input.column(3 * node + b).cast<double>();
      const RowMatrix<double> C = compressed->column(3 * node + b, input.steps());
      const double size = R.norm();
      const double share = size > 0.0 ? (C - R).norm() / size : 0.0;
      error.displacement = std::max(error.displacement, share);
      squares += share * share;
      ++error.measured_columns;
      for (int a = 0; a < 3; ++a) {
        expected.col(3 * a + b) = R.col(3 * node + a);
        actual.col(3 * a + b) = C.col(3 * node + a);
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
