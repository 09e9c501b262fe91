#include "precompute/modal/fingertip.hpp"

#include <algorithm>

namespace irdm::precompute {
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
