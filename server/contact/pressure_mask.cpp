#include "server/contact/pressure_mask.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace irdm {
namespace {

constexpr int kFewestRings = 4;
constexpr int kMostRings = 8;
constexpr double kLeastRings = 0.6;  // share of the radius that they cover at least

// Direction from which the rings start, in B; parallel to the normal of hardly any surface.
const Vector3 kReference = Vector3(0.7548776662, 0.5698402910, 0.3247179572).normalized();

}  // namespace

// Rings no farther apart than the nodes, with room to spare in a patch for (kMostRings + 1) nodes
// every way.
double PressureMask::largest_radius(const RestSurface& surface) noexcept {
  return kMostRings * 0.7 * surface.mean_edge();
}

PressureMask::PressureMask(const RestSurface& surface, double radius)
    : surface_(surface), radius_(radius) {
  if (radius <= 0) return;
  slot_.assign(static_cast<std::size_t>(surface.node_count()), -1);
  const int needed = static_cast<int>(std::ceil(radius / (0.7 * surface.mean_edge())));
  const int rings = std::clamp(needed, kFewestRings, kMostRings);
  // Passing a force on to corners widens it: its mean square distance from the middle, radius^2 / 3
  // for this pressure, grows by a quarter of the mean square edge. The rings are drawn in by as
  // much, but for meshes so coarse that little would be left of them.
  const double wanted = radius * radius - 0.75 * surface.mean_square_edge();
  const double laid = std::sqrt(std::max(wanted, kLeastRings * kLeastRings * radius * radius));
  // Equal rings 0 <= s <= 1, one sample for every sixth of the middle ring's length.
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

void PressureMask::add(int node, double weight, ContactPatch& patch) noexcept {
  int& slot = slot_[static_cast<std::size_t>(node)];
  if (slot < 0) {
    if (patch.count == kMaxPatchNodes) return;
    slot = patch.count;
    patch.add(node, 0.0);
  }
  patch.weights[static_cast<std::size_t>(slot)] += weight;
}

void PressureMask::spread(const SurfacePoint& middle, ContactPatch& patch) noexcept {
  if (samples_.empty()) {
    patch = ContactPatch(middle);
    return;
  }
  patch.count = 0;
  const SurfaceLocation centre = surface_.locate(middle);
  const Vector3 normal = area_normal(surface_.corners(centre.triangle)).normalized();
  const Vector3 x = (kReference - kReference.dot(normal) * normal).normalized();
  const Vector3 y = normal.cross(x);
  for (const Sample& sample : samples_) {
    const SurfaceLocation under =
        surface_.straight_on(centre, sample.cosine * x + sample.sine * y, sample.distance);
    for (std::size_t i = 0; i < 3; ++i) {
      if (under.point.weights[i] > 0) {
        add(under.point.nodes[i], sample.weight * under.point.weights[i], patch);
      }
    }
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
    slot_[static_cast<std::size_t>(patch.nodes[i])] = -1;
    sum += patch.weights[i];
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) patch.weights[i] /= sum;
}

}  // namespace irdm
