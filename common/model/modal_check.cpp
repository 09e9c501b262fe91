#include "common/model/modal_check.hpp"

#include <algorithm>
#include <cmath>

#include "common/config/lab_ranges.hpp"
#include "common/model/model_writer.hpp"

namespace irdm {
namespace {

using Fault = std::optional<std::string>;

// The largest share of a mode's mass that its rows at the surface may have; rightly at most 1.
constexpr double kMostModalMass = 4.0;
// A load as a multiple of the largest that a mode of modal mass 1 can feel.
constexpr double kMostLoad = 10.0;

Fault rate_fault(const ModalResponse& response) {
  const Eigen::VectorXd& omega = response.angular_frequency;
  if (omega.size() == 0) return "/response/modal has no modes";
  if (!std::ranges::all_of(omega, [](double w) { return lab::kModeFrequency.contains(w); })) {
    return "/response/modal/angular_frequency has a number that is not " +
           describe(lab::kModeFrequency);
  }
  if (!std::ranges::is_sorted(omega)) {
    return "/response/modal/angular_frequency has frequencies that do not increase";
  }
  if (!std::ranges::all_of(response.decay_rate,
                           [](double s) { return lab::kDecayRate.contains(s); })) {
    return "/response/modal/decay_rate has a number that is not " + describe(lab::kDecayRate);
  }
  return {};
}

template <typename Scalar>
Fault shape_fault(const Model& model, const Eigen::VectorXd& omega,
                  const RowMatrix<Scalar>& shapes) {
  if (!shapes.allFinite()) return "/response/modal/shapes has numbers that are not finite";
  const Eigen::RowVectorXd soft = omega.cwiseAbs2().cwiseInverse().transpose();
  Eigen::RowVectorXd modal_mass = Eigen::RowVectorXd::Zero(shapes.cols());
  for (Eigen::Index a = 0; a < shapes.rows(); ++a) {
    const Eigen::RowVectorXd square = shapes.row(a).template cast<double>().cwiseAbs2();
    const int node = model.mesh.surface_nodes[static_cast<std::size_t>(a / 3)];
    modal_mass += model.mesh.node_mass(node) * square;
    if (!lab::kCompliance.contains(square.dot(soft))) {
      return "/response/modal gives way by more than " + number_text(lab::kCompliance.highest) +
             " m/N";
    }
  }
  if (!(modal_mass.maxCoeff() <= kMostModalMass)) {
    return "/response/modal/shapes has shapes that are not mass-normalised";
  }
  return {};
}

Fault load_fault(const Model& model, const ModalResponse& response) {
  const double unit = std::sqrt(model.body.mass);
  const double radius = model.mesh.nodes.rowwise().norm().maxCoeff();
  const auto fault = [](const char* name, const auto& loads, double largest) -> Fault {
    if (!loads.allFinite()) return std::string(name) + " has numbers that are not finite";
    if (loads.size() == 0 || loads.cwiseAbs().maxCoeff() <= largest) return {};
    return std::string(name) + " has a load that no mode of this body can feel";
  };
  if (auto found = fault(kModalCentrifugal, response.centrifugal, kMostLoad * unit * radius)) {
    return found;
  }
  if (auto found = fault(kModalGravity, response.gravity, kMostLoad * unit)) return found;
  return fault(kModalGravityRest, response.gravity_rest, lab::kCompliance.highest);
}

}  // namespace

std::optional<std::string> modal_fault(const Model& model, const ModalResponse& response) {
  Fault fault = rate_fault(response);
  if (!fault) {
    fault = std::visit(
        [&](const auto& shapes) { return shape_fault(model, response.angular_frequency, shapes); },
        response.shapes);
  }
  if (!fault) fault = load_fault(model, response);
  return fault;
}

}  // namespace irdm
