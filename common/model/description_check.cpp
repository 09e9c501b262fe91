#include "common/model/description_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/config/lab_ranges.hpp"

namespace irdm {
namespace {

using Fault = std::optional<std::string>;

// Shares of the longest edge's power; precompute's own limit of a volume is 1e-9, which leaves no
// smaller share of a face.
constexpr double kSmallestVolume = 5e-10;
constexpr double kSmallestArea = 1e-9;
constexpr double kMassError = 1e-6;  // of the nodes' sum, as a share

Fault out_of(const Range& range, const char* name, double value) {
  if (range.contains(value)) return {};
  return std::string(name) + " is " + number_text(value) + ", not " + describe(range);
}

bool within(const int* begin, const int* end, Eigen::Index limit) {
  return std::all_of(begin, end, [limit](int i) { return i >= 0 && i < limit; });
}

Fault index_fault(const ModelMesh& mesh) {
  const auto& surface = mesh.surface_nodes;
  if (surface.empty() || mesh.triangles.rows() == 0) return "has no surface";
  if (mesh.tets.rows() == 0) return "/mesh/tets is empty";
  if (!within(mesh.tets.data(), mesh.tets.data() + mesh.tets.size(), mesh.nodes.rows())) {
    return "/mesh/tets points outside /mesh/nodes";
  }
  if (!within(surface.data(), surface.data() + surface.size(), mesh.nodes.rows())) {
    return "/mesh/surface_nodes points outside /mesh/nodes";
  }
  if (std::adjacent_find(surface.begin(), surface.end(), std::greater_equal<>()) != surface.end()) {
    return "/mesh/surface_nodes does not increase";
  }
  if (!within(mesh.triangles.data(), mesh.triangles.data() + mesh.triangles.size(),
              mesh.surface_node_count())) {
    return "/mesh/triangles points outside /mesh/surface_nodes";
  }
  return {};
}

double radius(const ModelMesh& mesh) {
  return mesh.nodes.rowwise().norm().maxCoeff();
}

Fault place_fault(const ModelMesh& mesh) {
  if (!mesh.nodes.allFinite()) return "/mesh/nodes has numbers that are not finite";
  if (!mesh.com_offset.allFinite()) return "/mesh com_offset is not finite";
  if (auto fault =
          out_of(lab::kMeshPlace, "/mesh com_offset", mesh.com_offset.cwiseAbs().maxCoeff()))
    return fault;
  return out_of(lab::kExtent, "the distance of the farthest of /mesh/nodes", radius(mesh));
}

Fault element_fault(const ModelMesh& mesh) {
  const auto at = [&](Eigen::Index e, int i) -> Vector3 { return mesh.nodes.row(mesh.tets(e, i)); };
  for (Eigen::Index e = 0; e < mesh.tets.rows(); ++e) {
    double longest = 0.0;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < i; ++j) longest = std::max(longest, (at(e, i) - at(e, j)).norm());
    }
    const Vector3 a = at(e, 0);
    const double volume = (at(e, 1) - a).cross(at(e, 2) - a).dot(at(e, 3) - a) / 6.0;
    if (volume > kSmallestVolume * longest * longest * longest) continue;
    return "/mesh/tets has an element that is flat or inverted, number " + std::to_string(e);
  }
  return {};
}

/// Flat triangles, open edges and one that faces inward, as a whole.
Fault surface_fault(const ModelMesh& mesh) {
  std::vector<std::pair<int, int>> edges;
  std::vector<std::pair<int, int>> back;
  double volume = 0.0;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const auto node = [&](int i) { return mesh.triangles(t, i % 3); };
    double longest = 0.0;
    for (int i = 0; i < 3; ++i) {
      edges.emplace_back(node(i), node(i + 1));
      back.emplace_back(node(i + 1), node(i));
      longest = std::max(
          longest, (mesh.rest_position(node(i)) - mesh.rest_position(node(i + 1))).squaredNorm());
    }
    const Vector3 a = mesh.rest_position(node(0));
    const Vector3 b = mesh.rest_position(node(1));
    const Vector3 c = mesh.rest_position(node(2));
    if (!(0.5 * (b - a).cross(c - a).norm() > kSmallestArea * longest)) {
      return "/mesh/triangles has a triangle without area, number " + std::to_string(t);
    }
    volume += a.dot(b.cross(c)) / 6.0;
  }
  std::ranges::sort(edges);
  std::ranges::sort(back);
  if (edges != back) return "the surface of /mesh/triangles is not closed";
  if (!(volume > 0.0)) return "/mesh/triangles face inward";
  return {};
}

Fault mass_fault(const Model& model) {
  const Eigen::VectorXd& mass = model.mesh.node_mass;
  if (!mass.allFinite() || mass.minCoeff() <= 0.0) {
    return "/mesh/node_mass must be finite and positive";
  }
  if (auto fault = out_of(lab::kMass, "/body mass", model.body.mass)) return fault;
  if (std::abs(mass.sum() - model.body.mass) > kMassError * model.body.mass) {
    return "/mesh/node_mass does not add up to /body mass";
  }
  return {};
}

// About the centre of mass no moment can be more than mass times the largest distance squared; the
// bounds are far from that.
Fault inertia_fault(const Model& model) {
  const Matrix3& inertia = model.body.inertia;
  if (!inertia.allFinite()) return "/body inertia has numbers that are not finite";
  if ((inertia - inertia.transpose()).norm() > 1e-9 * inertia.norm()) {
    return "/body inertia is not symmetric";
  }
  const Vector3 moments =
      Eigen::SelfAdjointEigenSolver<Matrix3>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  const double scale = model.body.mass * std::pow(radius(model.mesh), 2);
  if (!(moments.minCoeff() > 1e-14 * scale)) return "/body inertia must be positive definite";
  if (!(moments.maxCoeff() < 10.0 * scale)) {
    return "/body inertia is larger than a body of this mass and size can have";
  }
  return {};
}

Fault material_fault(const Material& material) {
  const struct {
    const char* name;
    double value;
    const Range& range;
  } numbers[] = {
      {"/material youngs_modulus", material.youngs_modulus, lab::kYoungsModulus},
      {"/material poisson_ratio", material.poisson_ratio, lab::kPoissonRatio},
      {"/material density", material.density, lab::kDensity},
      {"/material rayleigh_alpha", material.rayleigh_alpha, lab::kRayleighAlpha},
      {"/material rayleigh_beta", material.rayleigh_beta, lab::kRayleighBeta},
  };
  for (const auto& [name, value, range] : numbers) {
    if (auto fault = out_of(range, name, value)) return fault;
  }
  return {};
}

Fault step_fault(const Model& model) {
  if (auto fault = out_of(lab::kStepTime, "/response dt", model.dt)) return fault;
  if (model.steps >= 1 && model.steps <= lab::kMostSteps) return {};
  return "/response steps must be from 1 to " + std::to_string(lab::kMostSteps);
}

}  // namespace

std::optional<std::string> description_fault(const Model& model) {
  const ModelMesh& mesh = model.mesh;
  Fault fault = index_fault(mesh);
  if (!fault) fault = place_fault(mesh);
  if (!fault) fault = element_fault(mesh);
  if (!fault) fault = surface_fault(mesh);
  if (!fault) fault = mass_fault(model);
  if (!fault) fault = inertia_fault(model);
  if (!fault) fault = material_fault(model.material);
  if (!fault) fault = step_fault(model);
  return fault;
}

}  // namespace irdm
