#include "simulation/engine/static_compliance.hpp"

#include <limits>

#include "common/response/compressed_response.hpp"

namespace irdm {
namespace {

// sum_i (phi_i . d)^2 / omega_i^2, and what is left out.
template <typename Scalar>
double of_modes(const ModalResponse& response, const RowMatrix<Scalar>& shapes, std::size_t node,
                const Vector3& d) {
  const auto row = static_cast<Eigen::Index>(3 * node);
  const Eigen::RowVectorXd along =
      d.transpose() * shapes.middleRows(row, 3).template cast<double>();
  const double residual = response.residual.empty()
                              ? 0.0
                              : d.dot(response.residual.diagonal(static_cast<int>(node)) * d);
  return (along.array() / response.angular_frequency.transpose().array()).square().sum() + residual;
}

template <typename Scalar>
double of_history(const DenseResponse& response, const std::vector<Scalar>& values,
                  std::size_t node, const Vector3& d) {
  const auto dof = static_cast<std::size_t>(response.degrees_of_freedom);
  const auto steps = static_cast<std::size_t>(response.steps);
  double sum = 0.0;
  for (std::size_t b = 0; b < 3; ++b) {
    for (std::size_t a = 0; a < 3; ++a) {
      const Scalar* entry = values.data() + ((3 * node + b) * dof + 3 * node + a) * steps;
      double total = 0.0;
      for (std::size_t s = 0; s < steps; ++s) total += static_cast<double>(entry[s]);
      sum += total * d[static_cast<Eigen::Index>(a)] * d[static_cast<Eigen::Index>(b)];
    }
  }
  return sum;
}

template <typename Scalar>
double of_sums(const StreamedResponse& response, const std::vector<Scalar>& first, std::size_t node,
               const Vector3& d) {
  const auto dof = static_cast<std::size_t>(response.degrees_of_freedom);
  double sum = 0.0;
  for (std::size_t b = 0; b < 3; ++b) {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t at = (3 * node + b) * dof + 3 * node + a;
      const double total = static_cast<double>(first[at]) + static_cast<double>(response.rest[at]);
      sum += total * d[static_cast<Eigen::Index>(a)] * d[static_cast<Eigen::Index>(b)];
    }
  }
  return sum;
}

double of_compressed(const CompressedResponse& response, const Eigen::VectorXd& settled,
                     std::size_t node, const Vector3& d) {
  const auto i = static_cast<int>(node);
  double sum = 0.0;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      double entry = 0.0;
      for (int s = 0; s < response.fir_steps; ++s) {
        entry += early_response(response, i, a, i, b, s);
      }
      sum += entry * d[a] * d[b];
    }
  }
  const Eigen::VectorXd along = response.shapes.middleRows(3 * i, 3).cast<double>().transpose() * d;
  return sum + settled.dot(along.cwiseAbs2());
}

double compliance(const Model& model, std::size_t node, const Vector3& d) {
  if (const auto* modal = std::get_if<ModalResponse>(&model.response)) {
    return std::visit([&](const auto& shapes) { return of_modes(*modal, shapes, node, d); },
                      modal->shapes);
  }
  if (const auto* dense = std::get_if<DenseResponse>(&model.response)) {
    return std::visit([&](const auto& values) { return of_history(*dense, values, node, d); },
                      dense->values);
  }
  if (const auto* streamed = std::get_if<StreamedResponse>(&model.response)) {
    return std::visit([&](const auto& first) { return of_sums(*streamed, first, node, d); },
                      streamed->first);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::vector<float> static_compliance(const Model& model, const std::vector<Vector3>& directions) {
  std::vector<float> values;
  if (const auto* compressed = std::get_if<CompressedResponse>(&model.response)) {
    const Eigen::VectorXd settled = settled_late_responses(*compressed);
    for (std::size_t node = 0; node < directions.size(); ++node) {
      const double value = of_compressed(*compressed, settled, node, directions[node]);
      values.push_back(static_cast<float>(value));
    }
    return values;
  }
  for (std::size_t node = 0; node < directions.size(); ++node) {
    values.push_back(static_cast<float>(compliance(model, node, directions[node])));
  }
  return values;
}

}  // namespace irdm
