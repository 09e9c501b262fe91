#include "simulation/contact/near_field.hpp"

#include <math.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace irdm {
namespace {

constexpr int kSteps = 700;  // up to x = 14, where g is 1 / x within 0.5 %
// The integral over k, by Simpson's rule: exp(-k^p) is below 1e-18 at the end.
constexpr int kIntervals = 1200;

// Under a uniform pressure on a square of side s with a total force of 1 N, the mean displacement
// of the square is 2.973 / (pi E* s).
constexpr double kMeanOverSquare = 2.973;

// Distances between which the compliance of the rest of the body is evaluated, in element edges.
constexpr double kRingFrom = 1.0;
constexpr double kRingTo = 1.4;
constexpr std::size_t kMostOfRing = 48;
constexpr std::size_t kRingCandidates = 2000;
constexpr std::size_t kFewestOfRing = 6;
constexpr double kSameSide = 0.7071;  // cosine of 45 degrees
// Length of the mesh's low pass inside a flat face, in element edges. It is used where the ring has
// too few samples.
constexpr double kUsualLength = 0.22;
constexpr double kMaxLength = 0.6;  // its upper limit, in element edges
// A sample with less compliance than this, in units of 1 / (pi E* edge), is clamped.
constexpr double kClamped = 0.05;

double contact_modulus(const Model& model, int element) {
  double E = model.material.youngs_modulus;
  double nu = model.material.poisson_ratio;
  const ElementMaterials& elements = model.material.elements;
  if (!elements.empty() && element >= 0) {
    E = elements.youngs_modulus[static_cast<std::size_t>(element)];
    nu = elements.poisson_ratio[static_cast<std::size_t>(element)];
  }
  return E / (1.0 - nu * nu);
}

// Returns the displacement of one sample along its normal per force on another along its normal.
double compliance_between(const Eigen::MatrixXd& compliance, const BallSample& to,
                          const BallSample& from) {
  double sum = 0.0;
  for (std::size_t k = 0; k < to.node_count; ++k) {
    for (std::size_t l = 0; l < from.node_count; ++l) {
      const Matrix3 block = compliance.block<3, 3>(3 * to.nodes[k], 3 * from.nodes[l]);
      sum += to.weights[k] * from.weights[l] * to.normal.dot(block * from.normal);
    }
  }
  return sum;
}

// Returns up to kMostOfRing samples that lie about one edge away and face the same way, chosen
// among every `stride`-th sample.
std::vector<std::size_t> ring_about(std::size_t i, std::span<const BallSample> samples,
                                    std::size_t stride) {
  std::vector<std::size_t> ring;
  for (std::size_t j = 0; j < samples.size(); j += stride) {
    const double r = (samples[j].place.position - samples[i].place.position).norm();
    if (r < kRingFrom * samples[i].edge || r > kRingTo * samples[i].edge) continue;
    if (samples[j].normal.dot(samples[i].normal) > kSameSide) ring.push_back(j);
  }
  if (ring.size() <= kMostOfRing) return ring;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < kMostOfRing; ++k) {
    chosen.push_back(ring[k * ring.size() / kMostOfRing]);
  }
  return chosen;
}

}  // namespace

LowPass::LowPass(int power) : power_(power) {
  const double end = std::pow(42.0, 1.0 / power);
  const double h = end / kIntervals;
  for (int i = 0; i <= kSteps; ++i) {
    double sum = 0.0;
    for (int j = 0; j <= kIntervals; ++j) {
      const double k = j * h;
      const double weight = j == 0 || j == kIntervals ? 1.0 : (j % 2 == 1 ? 4.0 : 2.0);
      sum += weight * std::exp(-std::pow(k, power)) * ::j0(k * i / kStepsPerUnit);
    }
    values_.push_back(sum * h / 3.0);
  }
}

const LowPass& LowPass::of_order(int order) {
  static const LowPass linear(2);
  static const LowPass quadratic(3);
  return order == 1 ? linear : quadratic;
}

double LowPass::far(double x) const noexcept {
  // The Green's function without a low pass, and the leading term that the low pass adds.
  const double last = kSteps / kStepsPerUnit;
  const double ratio = last / x;
  double fading = ratio;
  for (int k = 0; k < power_; ++k) fading *= ratio;
  return 1.0 / x + (values_.back() - 1.0 / last) * fading;
}

NearField::NearField(const Model& model, const Eigen::MatrixXd& static_limit,
                     std::span<const BallSample> samples)
    : low_pass_(&LowPass::of_order(model.mesh.tets.cols() == 10 ? 2 : 1)) {
  const double g0 = low_pass_->at_zero();
  const std::size_t stride = std::max(std::size_t{1}, samples.size() / kRingCandidates);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const BallSample& sample = samples[i];
    const double scale = 1.0 / (std::numbers::pi * contact_modulus(model, sample.element));
    const double sample_length = g0 * std::sqrt(sample.area) / kMeanOverSquare;
    const double own = compliance_between(static_limit, sample, sample);
    double mesh_length = kUsualLength * sample.edge;
    const std::vector<std::size_t> ring = ring_about(i, samples, stride);
    if (own < kClamped * scale / sample.edge) {
      mesh_length = sample_length;
    } else if (ring.size() >= kFewestOfRing) {
      double share = 0.0;
      for (const std::size_t j : ring) {
        const double r = (samples[j].place.position - sample.place.position).norm();
        share += (compliance_between(static_limit, samples[j], sample) - scale / r) /
                 static_cast<double>(ring.size());
      }
      const double longest = kMaxLength * sample.edge;
      mesh_length = own > share ? std::min(g0 * scale / (own - share), longest) : longest;
    }
    places_.push_back({sample.place.position, 1.0 / sample_length,
                       1.0 / std::max(mesh_length, sample_length), std::sqrt(scale)});
  }
}

double NearField::between(int i, int j) const noexcept {
  const Place& a = places_[static_cast<std::size_t>(i)];
  const Place& b = places_[static_cast<std::size_t>(j)];
  const double fine = std::min(a.per_sample_length, b.per_sample_length);
  const double mesh = std::max(a.per_mesh_length, b.per_mesh_length);
  if (mesh >= fine) return 0.0;
  const double r = (a.position - b.position).norm();
  return a.scale * b.scale * ((*low_pass_)(r * fine) * fine - (*low_pass_)(r * mesh) * mesh);
}

}  // namespace irdm
