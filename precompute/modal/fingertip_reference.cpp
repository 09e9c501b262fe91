#include "precompute/modal/fingertip_reference.hpp"

#include <algorithm>

#include "precompute/blas_kernel.hpp"
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
                                       double contact_radius, const std::vector<int>& clamped)
    : model_(model), tips_(spread_fingertips(model.mesh, contact_radius, kSamples, clamped)) {
  const SingleThreadedBlas single;  // see lowest_modes()
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

double FingertipReference::expected_force_error(const ModalResponse& modes) const {
  const RowMatrix<double> held = held_responses(modes, model_.dt, press_steps(model_.dt));
  double worst = 0.0;
  for (std::size_t k = 0; k < tips_.size(); ++k) {
    const Eigen::VectorXd share = mean_under(tips_[k], shapes_of(modes));
    const double settled = mean_under(tips_[k], settled_.col(static_cast<Eigen::Index>(k)))(0);
    Eigen::VectorXd response = held * share.cwiseAbs2();
    response(0) += settled - share.cwiseQuotient(modes.angular_frequency).squaredNorm();
    worst = std::max(worst, press_error(response_[k], response, model_.dt));
  }
  return worst;
}

}  // namespace irdm::precompute
