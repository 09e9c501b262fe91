#include "precompute/modal/fingertip_reference.hpp"

#include <algorithm>
#include <cmath>

#include "precompute/modal/driving_spectrum.hpp"
#include "precompute/modal/held_responses.hpp"
#include "precompute/modal/press.hpp"

namespace irdm::precompute {
namespace {

constexpr int kQuadratureSteps = 80;

const RowMatrix<double>& shapes_of(const ModalResponse& modes) {
  return std::get<RowMatrix<double>>(modes.shapes);
}

double largest_norm(const Eigen::Ref<const Eigen::VectorXd>& u) {
  return Eigen::Map<const Points>(u.data(), u.size() / 3, 3).rowwise().norm().maxCoeff();
}

void keep_larger(ReductionError& kept, const ReductionError& other) {
  kept.force = std::max(kept.force, other.force);
  kept.shape = std::max(kept.shape, other.shape);
}

// G times the loads of a fingertip, (3n).
Eigen::VectorXd residual_displacement(const ResidualCompliance& residual, const Fingertip& tip,
                                      Eigen::Index size) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(size);
  if (residual.empty()) return u;
  for (std::size_t i = 0; i < tip.nodes.size(); ++i) {
    const auto node = static_cast<std::size_t>(tip.nodes[i]);
    for (int k = residual.row_start[node]; k < residual.row_start[node + 1]; ++k) {
      const Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>> block(
          residual.blocks.data() + 9 * static_cast<std::size_t>(k));
      u.segment<3>(3 * residual.nodes[static_cast<std::size_t>(k)]) +=
          tip.weights[i] * (block.cast<double>().transpose() * tip.direction);
    }
  }
  return u;
}

}  // namespace

FingertipReference::FingertipReference(const ElasticStatics& statics, const Model& model,
                                       double contact_radius, double residual_radius,
                                       const std::vector<int>& clamped)
    : model_(model),
      residual_radius_(residual_radius),
      tips_(spread_fingertips(model.mesh, contact_radius, kSamples, clamped)) {
  const Eigen::MatrixXd loads = loads_of(tips_, model.mesh);
  const Eigen::MatrixXd everywhere = statics.displacement(loads);
  settled_.resize(model.degrees_of_freedom(), loads.cols());
  for (int i = 0; i < model.mesh.surface_node_count(); ++i) {
    settled_.middleRows<3>(3 * i) =
        everywhere.middleRows<3>(3 * model.mesh.surface_nodes[static_cast<std::size_t>(i)]);
  }
  for (const DrivingSpectrum& spectrum : driving_spectra(statics, loads, kQuadratureSteps)) {
    response_.push_back(
        driving_response(spectrum, model.material, model.dt, press_steps(model.dt)));
  }
}

ReductionError FingertipReference::error(const ModalResponse& modes) const {
  const RowMatrix<double> held = held_responses(modes, model_.dt, press_steps(model_.dt));
  ReductionError worst;
  for (std::size_t k = 0; k < tips_.size(); ++k) {
    const Eigen::VectorXd share = mean_under(tips_[k], shapes_of(modes));
    const Eigen::VectorXd at_once =
        residual_displacement(modes.residual, tips_[k], settled_.rows());
    Eigen::VectorXd response = held * share.cwiseAbs2();
    response(0) += mean_under(tips_[k], at_once)(0);
    const Eigen::VectorXd settled =
        shapes_of(modes) * share.cwiseQuotient(modes.angular_frequency.cwiseAbs2()) + at_once;
    const auto all = settled_.col(static_cast<Eigen::Index>(k));
    keep_larger(worst, {press_error(response_[k], response, model_.dt),
                        largest_norm(settled - all) / largest_norm(all)});
  }
  return worst;
}

std::vector<bool> FingertipReference::near_all(const Fingertip& tip) const {
  std::vector<bool> near(static_cast<std::size_t>(model_.mesh.surface_node_count()), true);
  for (int j = 0; j < model_.mesh.surface_node_count(); ++j) {
    const Vector3 place = model_.mesh.rest_position(j);
    for (const int i : tip.nodes) {
      if ((model_.mesh.rest_position(i) - place).norm() > residual_radius_) {
        near[static_cast<std::size_t>(j)] = false;
      }
    }
  }
  return near;
}

void FingertipReference::add_errors(const ModalResponse& modes, Eigen::Index tip,
                                    std::vector<ReductionError>& errors) const {
  const Fingertip& fingertip = tips_[static_cast<std::size_t>(tip)];
  const Eigen::VectorXd& all = response_[static_cast<std::size_t>(tip)];
  const RowMatrix<double> held = held_responses(modes, model_.dt, press_steps(model_.dt));
  const Eigen::VectorXd share = mean_under(fingertip, shapes_of(modes));
  const std::vector<bool> near = near_all(fingertip);
  Eigen::VectorXd missing = settled_.col(tip);
  for (std::size_t j = 0; j < near.size(); ++j) {
    if (near[j]) missing.segment<3>(static_cast<Eigen::Index>(3 * j)).setZero();
  }
  const double scale = largest_norm(settled_.col(tip));
  Eigen::VectorXd response = Eigen::VectorXd::Zero(all.size());
  response(0) = mean_under(fingertip, settled_.col(tip))(0);
  for (Eigen::Index i = 0; i < share.size(); ++i) {
    const double settled = share(i) / std::pow(modes.angular_frequency(i), 2);
    response += share(i) * share(i) * held.col(i);
    response(0) -= share(i) * settled;
    for (std::size_t j = 0; j < near.size(); ++j) {
      if (near[j]) continue;
      const auto row = static_cast<Eigen::Index>(3 * j);
      missing.segment<3>(row) -= settled * shapes_of(modes).col(i).segment<3>(row);
    }
    keep_larger(errors[static_cast<std::size_t>(i)],
                {press_error(all, response, model_.dt), largest_norm(missing) / scale});
  }
}

std::vector<ReductionError> FingertipReference::errors_by_count(const ModalResponse& modes) const {
  std::vector<ReductionError> errors(static_cast<std::size_t>(modes.mode_count()));
  for (int k = 0; k < samples(); ++k) add_errors(modes, k, errors);
  return errors;
}

}  // namespace irdm::precompute
