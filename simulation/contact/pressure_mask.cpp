#include "simulation/contact/pressure_mask.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace irdm {
namespace {

constexpr int kFewestRings = 4;
constexpr int kMostRings = 9;
constexpr double kLeastRings = 0.6;  // share of the radius that they cover at least
constexpr int kMostSamples = 3 * kMostRings * kMostRings;
static_assert(kMostSamples <= kMaxPatchNodes, "a node for each sample must have room in a patch");

// Direction from which the rings start, in B; parallel to the normal of hardly any surface.
const Vector3 kReference(0.7548776662, 0.5698402910, 0.3247179572);

// Rings no farther apart than the nodes. An even mesh has pi (kMostRings + 1)^2 nodes there at
// most, for which a patch has room.
int ring_count(const RestSurface& surface, double radius) noexcept {
  const int needed = static_cast<int>(std::ceil(radius / (0.7 * surface.mean_edge())));
  return std::clamp(needed, kFewestRings, kMostRings);
}

// Passing a force on to corners widens it: its mean square distance from the middle, radius^2 / 3
// for this pressure, grows by a quarter of the mean square edge. The rings are drawn in by as much,
// but for meshes so coarse that little would be left of them.
double ring_radius(const RestSurface& surface, double radius) noexcept {
  const double wanted = radius * radius - 0.75 * surface.mean_square_edge();
  return std::sqrt(std::max(wanted, kLeastRings * kLeastRings * radius * radius));
}

}  // namespace

double PressureMask::largest_radius(const RestSurface& surface) noexcept {
  return kMostRings * 0.7 * surface.mean_edge();
}

// Rings of equal width, one sample for every sixth of the middle ring's length.
PressureMask::PressureMask(const RestSurface& surface, double radius)
    : surface_(surface),
      radius_(radius),
      slot_(static_cast<std::size_t>(surface.node_count()), -1) {
  const double laid = ring_radius(surface, radius);
  const int rings = ring_count(surface, radius);
  double total = 0.0;
  for (int ring = 0; ring < rings; ++ring) {
    const double inner = static_cast<double>(ring) / rings;
    const double outer = static_cast<double>(ring + 1) / rings;
    const double s = 0.5 * (inner + outer);
    const int count = 6 * ring + 3;
    const double share = (1.0 - s * s) * (outer * outer - inner * inner) / count;
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * std::numbers::pi * (i + 0.5 * (ring % 2)) / count;
      samples_.push_back({std::cos(angle), std::sin(angle), laid * s, share});
      total += share;
    }
  }
  for (Sample& sample : samples_) sample.weight /= total;
}

bool PressureMask::add(int node, double weight, ContactPatch& patch) noexcept {
  int& slot = slot_[static_cast<std::size_t>(node)];
  if (slot < 0) {
    if (patch.count == kMaxPatchNodes) return false;
    slot = patch.count;
    patch.add(node, 0.0);
  }
  patch.weights[static_cast<std::size_t>(slot)] += weight;
  return true;
}

bool PressureMask::add_to_corners(const SurfacePoint& at, double weight,
                                  ContactPatch& patch) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    if (at.weights[i] > 0 && !add(at.nodes[i], weight * at.weights[i], patch)) return false;
  }
  return true;
}

bool PressureMask::add_to_nearest(const SurfacePoint& at, double weight,
                                  ContactPatch& patch) noexcept {
  const auto largest = std::ranges::max_element(at.weights) - at.weights.begin();
  return add(at.nodes[static_cast<std::size_t>(largest)], weight, patch);
}

void PressureMask::spread(const SurfacePoint& middle, ContactPatch& patch) noexcept {
  if (radius_ <= 0) {
    patch = ContactPatch(middle);
    return;
  }
  if (laid_.count == 0 || middle_.nodes != middle.nodes || middle_.weights != middle.weights) {
    lay(middle, laid_);
    middle_ = middle;
  }
  patch.count = laid_.count;
  std::copy_n(laid_.nodes.begin(), laid_.count, patch.nodes.begin());
  std::copy_n(laid_.weights.begin(), laid_.count, patch.weights.begin());
}

void PressureMask::lay(const SurfacePoint& middle, ContactPatch& patch) noexcept {
  if (!lay(middle, &PressureMask::add_to_corners, patch)) {
    lay(middle, &PressureMask::add_to_nearest, patch);
  }
}

bool PressureMask::lay(const SurfacePoint& middle, AddSample add_sample,
                       ContactPatch& patch) noexcept {
  patch.count = 0;
  const SurfaceLocation centre = surface_.locate(middle);
  const Vector3 normal = area_normal(surface_.corners(centre.triangle)).normalized();
  const Vector3 x = (kReference - kReference.dot(normal) * normal).normalized();
  const Vector3 y = normal.cross(x);
  const bool all = std::ranges::all_of(samples_, [&](const Sample& sample) {
    const Vector3 direction = sample.cosine * x + sample.sine * y;
    const SurfaceLocation at = surface_.straight_on(centre, direction, sample.distance);
    return (this->*add_sample)(at.point, sample.weight, patch);
  });
  normalise(patch);
  return all;
}

void PressureMask::normalise(ContactPatch& patch) noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
    slot_[static_cast<std::size_t>(patch.nodes[i])] = -1;
    sum += patch.weights[i];
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) patch.weights[i] /= sum;
}

}  // namespace irdm
