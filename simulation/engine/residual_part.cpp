#include "simulation/engine/residual_part.hpp"

#include <algorithm>
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
        entry += fir_response(response, i, a, i, b, s);
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
    const Eigen::VectorXd settled = settled_tail_responses(*compressed);
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

ResidualPart::ResidualPart(const ResidualCompliance& compliance, int surface_nodes)
    : compliance_(compliance) {
  if (compliance.empty()) return;
  field_.assign(index(surface_nodes), Matrix3::Zero());
  force_.assign(index(surface_nodes), Vector3::Zero());
  is_loaded_.assign(index(surface_nodes), 0);
  loaded_.reserve(index(surface_nodes));
}

void ResidualPart::spread(const ContactPatch& patch) noexcept {
  for (std::size_t i = 0; i < index(patch.count); ++i) {
    for (int k = begin_of(patch.nodes[i]); k < end_of(patch.nodes[i]); ++k) {
      field_[index(column(k))] += patch.weights[i] * block(k).cast<double>();
    }
  }
}

void ResidualPart::clear(const ContactPatch& patch) noexcept {
  for (std::size_t i = 0; i < index(patch.count); ++i) {
    for (int k = begin_of(patch.nodes[i]); k < end_of(patch.nodes[i]); ++k) {
      field_[index(column(k))].setZero();
    }
  }
}

// G is symmetric: the field of contact b at the nodes of a, transposed, is block (b, a).
void ResidualPart::add_compliance(std::span<const ContactPatch> patches,
                                  ContactMatrix& compliance) noexcept {
  if (compliance_.empty()) return;
  for (std::size_t b = 0; b < patches.size(); ++b) {
    spread(patches[b]);
    for (std::size_t a = 0; a <= b; ++a) {
      Matrix3 sum = Matrix3::Zero();
      for (std::size_t i = 0; i < index(patches[a].count); ++i) {
        sum += patches[a].weights[i] * field_[index(patches[a].nodes[i])];
      }
      const auto row = static_cast<Eigen::Index>(3 * b);
      const auto column = static_cast<Eigen::Index>(3 * a);
      if (a == b) sum = 0.5 * (sum + sum.transpose()).eval();
      compliance.block<3, 3>(row, column) += sum;
      if (a != b) compliance.block<3, 3>(column, row) += sum.transpose();
    }
    clear(patches[b]);
  }
}

Matrix3 ResidualPart::compliance(const ContactPatch& patch) noexcept {
  Matrix3 sum = Matrix3::Zero();
  if (compliance_.empty()) return sum;
  spread(patch);
  for (std::size_t i = 0; i < index(patch.count); ++i) {
    sum += patch.weights[i] * field_[index(patch.nodes[i])];
  }
  clear(patch);
  return 0.5 * (sum + sum.transpose());
}

Vector3 ResidualPart::displacement(const ContactPatch& patch,
                                   std::span<const NodalForce> forces) noexcept {
  Vector3 sum = Vector3::Zero();
  if (compliance_.empty() || forces.empty()) return sum;
  spread(patch);
  for (const NodalForce& nodal : forces) {
    sum += field_[index(nodal.node)] * nodal.force;
  }
  clear(patch);
  return sum;
}

void ResidualPart::release() noexcept {
  for (const int node : loaded_) {
    force_[index(node)].setZero();
    is_loaded_[index(node)] = 0;
  }
  loaded_.clear();
}

void ResidualPart::hold_more(std::span<const NodalForce> forces) noexcept {
  if (compliance_.empty()) return;
  for (const NodalForce& nodal : forces) {
    if (is_loaded_[index(nodal.node)] == 0) loaded_.push_back(nodal.node);
    is_loaded_[index(nodal.node)] = 1;
    force_[index(nodal.node)] += nodal.force;
  }
}

void ResidualPart::hold(std::span<const NodalForce> forces) noexcept {
  release();
  hold_more(forces);
}

void ResidualPart::add_displacement(Points& u) const noexcept {
  for (const int node : loaded_) {
    for (int k = begin_of(node); k < end_of(node); ++k) {
      u.row(column(k)) += (block(k).cast<double>().transpose() * force_[index(node)]).transpose();
    }
  }
}

void ResidualPart::add_all(Eigen::MatrixXd& compliance) const {
  if (compliance_.empty()) return;
  for (int i = 0; i + 1 < static_cast<int>(compliance_.row_start.size()); ++i) {
    for (int k = begin_of(i); k < end_of(i); ++k) {
      compliance.block<3, 3>(3 * i, 3 * column(k)) += block(k).cast<double>();
    }
  }
}

}  // namespace irdm
