#include "precompute/modal/fingertip.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/response/modal_response.hpp"
#include "precompute/blas.hpp"
#include "precompute/modal/driving_spectrum.hpp"
#include "precompute/modal/elastic_statics.hpp"

namespace irdm::precompute {
namespace {

constexpr double kPressTime = 0.1;  // [s]

double indentation(double t, double time) {
  return 0.5 * (1.0 - std::cos(std::numbers::pi * std::min(t / time, 1.0)));
}

}  // namespace

double press_time(double dt) {
  return std::max(kPressTime, 10.0 * dt);
}

int press_steps(double dt) {
  return static_cast<int>(std::ceil(2.0 * press_time(dt) / dt));
}

Eigen::VectorXd press_force(const Eigen::VectorXd& response, double dt) {
  const int steps = press_steps(dt);
  Eigen::VectorXd force(steps);
  for (int k = 0; k < steps; ++k) {
    double past = 0.0;
    for (int s = 1; s <= k; ++s) past += response(s) * force(k - s);
    force(k) = (indentation((k + 1) * dt, press_time(dt)) - past) / response(0);
  }
  return force;
}

double press_error(const Eigen::VectorXd& all, const Eigen::VectorXd& found, double dt) {
  const Eigen::VectorXd expected = press_force(all, dt);
  return (press_force(found, dt) - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

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

namespace {

// Sum of the normals of each node's triangles, as long as a third of their area.
Points node_areas(const ModelMesh& mesh) {
  Points areas = Points::Zero(mesh.surface_node_count(), 3);
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const auto corner = [&](int k) { return mesh.rest_position(mesh.triangles(t, k)); };
    const Vector3 area = (corner(1) - corner(0)).cross(corner(2) - corner(0)) / 6.0;
    for (int k = 0; k < 3; ++k) areas.row(mesh.triangles(t, k)) += area.transpose();
  }
  return areas;
}

Points surface_points(const ModelMesh& mesh) {
  return mesh.nodes(mesh.surface_nodes, Eigen::all);
}

// Each the farthest from those before it.
std::vector<int> far_apart(const Points& points, const std::vector<bool>& allowed, int count) {
  std::vector<int> chosen;
  Eigen::VectorXd distance = points.rowwise().squaredNorm().cwiseInverse();  // the nearest first
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (!allowed[static_cast<std::size_t>(i)]) distance(i) = -1.0;
  }
  for (int k = 0; k < count; ++k) {
    Eigen::Index next = 0;
    if (!(distance.maxCoeff(&next) > 0.0)) break;
    chosen.push_back(static_cast<int>(next));
    const Eigen::VectorXd from_it = (points.rowwise() - points.row(next)).rowwise().squaredNorm();
    distance = k == 0 ? Eigen::VectorXd((distance.array() < 0.0).select(distance, from_it))
                      : distance.cwiseMin(from_it);
  }
  return chosen;
}

Fingertip fingertip_at(int middle, double radius, const Points& points, const Points& areas) {
  Fingertip tip;
  const Vector3 normal = areas.row(middle).normalized().transpose();
  double sum = 0.0;
  for (int i = 0; i < points.rows(); ++i) {
    const double s = (points.row(i) - points.row(middle)).norm() / radius;
    if (i != middle && (s >= 1.0 || areas.row(i).dot(normal) <= 0.0)) continue;
    tip.nodes.push_back(i);
    tip.weights.push_back(areas.row(i).norm() * (1.0 - s * s));
    sum += tip.weights.back();
  }
  for (double& weight : tip.weights) weight /= sum;
  tip.direction = -normal;
  return tip;
}

}  // namespace

std::vector<Fingertip> spread_fingertips(const ModelMesh& mesh, double radius, int count,
                                         const std::vector<int>& clamped) {
  const Points points = surface_points(mesh);
  const Points areas = node_areas(mesh);
  const auto moves = [&](int i) {
    return !std::binary_search(clamped.begin(), clamped.end(),
                               mesh.surface_nodes[static_cast<std::size_t>(i)]);
  };
  std::vector<bool> allowed(static_cast<std::size_t>(points.rows()), true);
  for (int i = 0; i < points.rows(); ++i) {
    if (moves(i)) continue;
    for (int j = 0; j < points.rows(); ++j) {
      if ((points.row(i) - points.row(j)).norm() < radius) {
        allowed[static_cast<std::size_t>(j)] = false;
      }
    }
  }
  if (std::find(allowed.begin(), allowed.end(), true) == allowed.end()) {
    for (int i = 0; i < points.rows(); ++i) allowed[static_cast<std::size_t>(i)] = moves(i);
  }
  std::vector<Fingertip> tips;
  for (const int middle : far_apart(points, allowed, count)) {
    tips.push_back(fingertip_at(middle, radius, points, areas));
  }
  return tips;
}

Eigen::MatrixXd loads_of(const std::vector<Fingertip>& tips, const ModelMesh& mesh) {
  Eigen::MatrixXd loads =
      Eigen::MatrixXd::Zero(3 * mesh.nodes.rows(), static_cast<Eigen::Index>(tips.size()));
  for (std::size_t k = 0; k < tips.size(); ++k) {
    for (std::size_t i = 0; i < tips[k].nodes.size(); ++i) {
      const int node = mesh.surface_nodes[static_cast<std::size_t>(tips[k].nodes[i])];
      loads.block<3, 1>(3 * node, static_cast<Eigen::Index>(k)) =
          tips[k].weights[i] * tips[k].direction;
    }
  }
  return loads;
}

Eigen::VectorXd mean_under(const Fingertip& tip, const Eigen::Ref<const Eigen::MatrixXd>& values) {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(values.cols());
  for (std::size_t i = 0; i < tip.nodes.size(); ++i) {
    mean += tip.weights[i] * (values.middleRows<3>(3 * tip.nodes[i]).transpose() * tip.direction);
  }
  return mean;
}

}  // namespace irdm::precompute
