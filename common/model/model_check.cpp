#include "common/model/model_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/config/range.hpp"
#include "common/dense_algebra.hpp"
#include "common/model/model_writer.hpp"

namespace irdm {
namespace {

using FaultText = std::optional<std::string>;

// Shares of the longest edge's power; precompute's own limit of a volume is 1e-9, which leaves no
// smaller share of a face.
constexpr double kSmallestVolume = 5e-10;
constexpr double kSmallestArea = 1e-9;
constexpr double kMassError = 1e-6;  // of the nodes' sum, as a share

FaultText out_of(const Range& range, const char* name, double value) {
  if (range.contains(value)) return {};
  return std::string(name) + " " + outside_text(range, value);
}

bool within(const int* begin, const int* end, Eigen::Index limit) {
  return std::all_of(begin, end, [limit](int i) { return i >= 0 && i < limit; });
}

FaultText index_fault(const ModelMesh& mesh) {
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

FaultText place_fault(const ModelMesh& mesh) {
  if (!mesh.nodes.allFinite()) return "/mesh/nodes has numbers that are not finite";
  if (!mesh.com_offset.allFinite()) return "/mesh com_offset is not finite";
  if (auto fault =
          out_of(lab::kMeshPlace, "/mesh com_offset", mesh.com_offset.cwiseAbs().maxCoeff()))
    return fault;
  return out_of(lab::kExtent, "the distance of the farthest of /mesh/nodes", radius(mesh));
}

FaultText element_fault(const ModelMesh& mesh) {
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
FaultText surface_fault(const ModelMesh& mesh) {
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

FaultText mass_fault(const Model& model) {
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
FaultText inertia_fault(const Model& model) {
  const Matrix3& inertia = model.body.inertia;
  if (!inertia.allFinite()) return "/body inertia has numbers that are not finite";
  if ((inertia - inertia.transpose()).norm() > 1e-9 * inertia.norm()) {
    return "/body inertia is not symmetric";
  }
  const Vector3 moments = symmetric_eigenvalues(inertia);
  const double scale = model.body.mass * std::pow(radius(model.mesh), 2);
  if (!(moments.minCoeff() > 1e-14 * scale)) return "/body inertia must be positive definite";
  if (!(moments.maxCoeff() < 10.0 * scale)) {
    return "/body inertia is larger than a body of this mass and size can have";
  }
  return {};
}

FaultText element_materials_fault(const Model& model) {
  const ElementMaterials& elements = model.material.elements;
  if (elements.empty()) return {};
  const struct {
    const char* name;
    const std::vector<double>& values;
    const Range& range;
    bool there;
  } all[] = {
      {kElementYoungsModulus, elements.youngs_modulus, lab::kYoungsModulus, !is_rigid(model)},
      {kElementPoissonRatio, elements.poisson_ratio, lab::kPoissonRatio, !is_rigid(model)},
      {kElementDensity, elements.density, lab::kDensity, true},
  };
  const auto count = static_cast<std::size_t>(model.mesh.tets.rows());
  for (const auto& [name, values, range, there] : all) {
    if (values.size() != (there ? count : 0)) {
      return std::string(name) + " has not one number for each of /mesh/tets";
    }
    for (const double value : values) {
      if (auto fault = out_of(range, (std::string("a number of ") + name).c_str(), value)) {
        return fault;
      }
    }
  }
  if (elements.region.size() != count || std::ranges::min(elements.region) < 0) {
    return std::string(kElementRegion) + " has not one number from 0 for each of /mesh/tets";
  }
  return {};
}

FaultText material_fault(const Model& model) {
  const Material& material = model.material;
  if (auto fault = out_of(lab::kDensity, "/material density", material.density)) return fault;
  if (auto fault = element_materials_fault(model)) return fault;
  if (is_rigid(model)) return {};
  const struct {
    const char* name;
    double value;
    const Range& range;
  } numbers[] = {
      {"/material youngs_modulus", material.youngs_modulus, lab::kYoungsModulus},
      {"/material poisson_ratio", material.poisson_ratio, lab::kPoissonRatio},
      {"/material rayleigh_alpha", material.rayleigh_alpha, lab::kRayleighAlpha},
      {"/material rayleigh_beta", material.rayleigh_beta, lab::kRayleighBeta},
  };
  for (const auto& [name, value, range] : numbers) {
    if (auto fault = out_of(range, name, value)) return fault;
  }
  return {};
}

FaultText step_fault(const Model& model) {
  if (auto fault = out_of(lab::kStepTime, "/response dt", model.dt)) return fault;
  if (is_rigid(model) && model.steps != 1) return "/response steps of a rigid body must be 1";
  if (model.steps >= 1 && model.steps <= lab::kMostSteps) return {};
  return "/response steps must be from 1 to " + std::to_string(lab::kMostSteps);
}

}  // namespace

std::optional<std::string> description_fault(const Model& model) {
  const ModelMesh& mesh = model.mesh;
  FaultText fault = index_fault(mesh);
  if (!fault) fault = place_fault(mesh);
  if (!fault) fault = element_fault(mesh);
  if (!fault) fault = surface_fault(mesh);
  if (!fault) fault = mass_fault(model);
  if (!fault) fault = inertia_fault(model);
  if (!fault) fault = material_fault(model);
  if (!fault) fault = step_fault(model);
  return fault;
}

namespace {

constexpr int kDegreesOfFreedom = 16;
constexpr int kSteps = 32;
/// Of R(a, b) less R(b, a), as a share of the largest R(b, b): what stepping in time leaves is
/// far below.
constexpr double kDenseAsymmetry = 0.02;

// Evenly spread over [0, count).
std::vector<int> spread(int count, int most) {
  const int taken = std::min(count, most);
  std::vector<int> sample;
  for (int i = 0; i < taken; ++i) {
    sample.push_back(static_cast<int>(static_cast<long>(i) * count / taken));
  }
  return sample;
}

}  // namespace

DenseSamples::DenseSamples(int degrees_of_freedom, int steps)
    : degrees_of_freedom_(degrees_of_freedom),
      steps_(steps),
      sample_(spread(degrees_of_freedom_, kDegreesOfFreedom)),
      step_sample_(spread(steps_, kSteps)),
      peak_(static_cast<std::size_t>(degrees_of_freedom_), 0.0),
      sum_(peak_),
      first_(peak_) {
  const auto count = static_cast<Eigen::Index>(sample_.size() * step_sample_.size());
  columns_.setZero(degrees_of_freedom_, count);
  rows_.setZero(degrees_of_freedom_, count);
}

template <typename Scalar>
void DenseSamples::add(int b, const Scalar* column) {
  const auto at = [&](int s, int a) {
    return static_cast<double>(column[static_cast<std::ptrdiff_t>(s) * degrees_of_freedom_ + a]);
  };
  auto& peak = peak_[static_cast<std::size_t>(b)];
  auto& sum = sum_[static_cast<std::size_t>(b)];
  first_[static_cast<std::size_t>(b)] = at(0, b);
  for (int s = 0; s < steps_; ++s) {
    peak = std::max(peak, std::abs(at(s, b)));
    sum += at(s, b);
  }
  Eigen::Index place = 0;
  for (const int sampled : sample_) {
    for (const int s : step_sample_) {
      rows_(b, place) = at(s, sampled);
      if (sampled == b) {
        for (int a = 0; a < degrees_of_freedom_; ++a) columns_(a, place) = at(s, a);
      }
      ++place;
    }
  }
}

std::optional<std::string> DenseSamples::fault() const {
  const double largest = *std::ranges::max_element(peak_);
  for (std::size_t b = 0; b < peak_.size(); ++b) {
    if (peak_[b] <= 0.0) continue;  // clamped
    if (!(sum_[b] > 0.0 && first_[b] > 0.0)) {
      return "gives way against the force on degree of freedom " + std::to_string(b);
    }
  }
  if (!((columns_ - rows_).cwiseAbs().maxCoeff() <= kDenseAsymmetry * largest)) {
    return "is not symmetric: a on b is not what b is on a";
  }
  return {};
}

template void DenseSamples::add(int, const float*);
template void DenseSamples::add(int, const double*);

namespace {

// The largest share of a mode's mass that its rows at the surface may have; rightly at most 1.
constexpr double kMostModalMass = 4.0;
// A load as a multiple of the largest that a mode of modal mass 1 can feel.
constexpr double kMostLoad = 10.0;

FaultText rate_fault(const ModalResponse& response) {
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

// A floating body has a response to its own spin, a fixed one a response to gravity and nodes that
// no mode moves.
template <typename Scalar>
FaultText support_fault(const Model& model, const ModalResponse& response,
                        const RowMatrix<Scalar>& shapes) {
  const bool spins = response.centrifugal.rows() > 0;
  const bool sags = response.gravity.rows() > 0;
  if (spins == sags || spins == (model.body.support == Support::kFloating)) return {};
  if (sags) return "/body support is floating, but the modes are those of a fixed body";
  for (Eigen::Index a = 0; a < shapes.rows(); a += 3) {
    if (shapes.middleRows(a, 3).isZero(Scalar{0})) return {};  // of a version without gravity
  }
  return "/body support is fixed, but the modes are those of a floating body";
}

template <typename Scalar>
FaultText shape_fault(const Model& model, const Eigen::VectorXd& omega,
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

FaultText load_fault(const Model& model, const ModalResponse& response) {
  const double unit = std::sqrt(model.body.mass);
  const double radius = model.mesh.nodes.rowwise().norm().maxCoeff();
  const auto fault = [](const char* name, const auto& loads, double largest) -> FaultText {
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
  FaultText fault = rate_fault(response);
  if (!fault) {
    fault = std::visit(
        [&](const auto& shapes) {
          const FaultText found = shape_fault(model, response.angular_frequency, shapes);
          return found ? found : support_fault(model, response, shapes);
        },
        response.shapes);
  }
  if (!fault) fault = load_fault(model, response);
  return fault;
}

}  // namespace irdm
