#include "simulation/contact/self_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include "common/dense_algebra.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {
namespace {

// Parts that can meet have normals against each other: cosine of their angle at most.
constexpr double kFacing = -0.3;
// They lie in front of each other: sine of the angle to either's plane at least.
constexpr double kInFront = 0.1;
// Share of the way from a part to another by whose end nothing may be between.
constexpr double kSight = 0.999;
// Shares of the second and third direction in which parts face that the first is turned by, so that
// none of them faces across it.
constexpr double kSecond = 0.3;
constexpr double kThird = 0.1;
// Two points come nearer by at most so many times what a component of a displacement is.
const double kBothWays = 2.0 * std::sqrt(3.0);
// Share of a distance that is relied on: a walk may have ended before the nearest point.
constexpr double kReliable = 0.5;

bool share_node(const SurfacePatch& patch, const std::array<int, 3>& corners) {
  return std::any_of(corners.begin(), corners.end(), [&](int corner) {
    return std::find(patch.nodes.begin(), patch.nodes.end(), corner) != patch.nodes.end();
  });
}

// Distance from a sample to a triangle that it sees and that sees it [m]; negative: it does not.
double sight(const RestSurface& surface, const ContactSampling& sampling,
             const ContactSampling::Sample& sample, int triangle, double reach) {
  const Vector3& normal = surface.plane(triangle).normal;
  if (sample.normal.dot(normal) > kFacing) return -1.0;
  const TriangleCorners corners = surface.corners(triangle);
  const Vector3& p = sample.place.position;
  if (std::none_of(corners.begin(), corners.end(),
                   [&](const Vector3& corner) { return (corner - p).dot(sample.normal) > 0.0; })) {
    return -1.0;
  }
  const Vector3 way = at(corners, closest_point(corners, p)) - p;
  const double distance = way.norm();
  if (distance > reach || way.dot(sample.normal) <= kInFront * distance ||
      -way.dot(normal) <= kInFront * distance) {
    return -1.0;
  }
  if (share_node(sampling.patch(sample.row), surface.topology().corners(triangle))) return -1.0;
  return surface.tree().first_entry(p, p + kSight * way) ? -1.0 : distance;
}

// A direction that no two parts face across.
Vector3 leading_direction(const Matrix3& facings) {
  const Matrix3 axes = symmetric_eigenpairs(facings).vectors;
  return axes.col(2) + kSecond * axes.col(1) + kThird * axes.col(0);
}

}  // namespace

SelfReach::SelfReach(const RestSurface& surface, const ContactSampling& sampling)
    : sampling_(sampling),
      triangle_count_(static_cast<std::size_t>(surface.triangle_count())),
      rows_(sampling.samples().size(), -1),
      nearest_(rows_.size(), 0),
      gaps_(rows_.size(), std::numeric_limits<double>::infinity()),
      least_gap_(std::numeric_limits<double>::infinity()) {
  const double reach = surface.bounding_radius();
  std::vector<View> views;
  Matrix3 facings = Matrix3::Zero();
  for (int s = 0; s < sample_count(); ++s) {
    const ContactSampling::Sample& sample = sampling.samples()[static_cast<std::size_t>(s)];
    for (int t = 0; t < surface.triangle_count(); ++t) {
      const double distance = sight(surface, sampling, sample, t, reach);
      if (distance < 0.0) continue;
      const Vector3 facing = (sample.normal - surface.plane(t).normal).normalized();
      facings += sample.area * facing * facing.transpose();
      views.push_back({s, t, distance, facing});
    }
  }
  const Vector3 leading = leading_direction(facings);
  for (const View& view : views) {
    if (view.sample >= sampling.first_edge() || view.facing.dot(leading) > 0.0) add(view);
  }
}

void SelfReach::add(const View& view) {
  const auto sample = static_cast<std::size_t>(view.sample);
  if (rows_[sample] < 0) {
    rows_[sample] = static_cast<int>(flags_.size() / triangle_count_);
    flags_.resize(flags_.size() + triangle_count_, 0);
  }
  const auto first = static_cast<std::size_t>(rows_[sample]) * triangle_count_;
  flags_[first + static_cast<std::size_t>(view.triangle)] = 1;
  if (view.distance < gaps_[sample]) nearest_[sample] = view.triangle;
  gaps_[sample] = std::min(gaps_[sample], view.distance);
  least_gap_ = std::min(least_gap_, view.distance);
  any_ = true;
}

SelfSearch::SelfSearch(const SelfReach& reach, DeformedSurface& surface, double ahead)
    : reach_(reach),
      surface_(surface),
      ahead_(ahead),
      seen_(static_cast<std::size_t>(reach.sample_count())) {
  reset();
}

void SelfSearch::reset() noexcept {
  for (int s = 0; s < reach_.sample_count(); ++s) {
    seen_[static_cast<std::size_t>(s)] = {reach_.nearest(s), false, reach_.place(s), 0.0, {}};
  }
}

void SelfSearch::archive(StateArchive& state) {
  state.values(seen_);
}

bool SelfSearch::begin_step() noexcept {
  if (reach_.least_gap() - kBothWays * surface_.bound() > ahead_) return false;
  surface_.keep();
  return true;
}

bool SelfSearch::is_far(int sample) noexcept {
  if (reach_.across(sample).empty()) return true;
  const Seen& seen = seen_[static_cast<std::size_t>(sample)];
  if (reach_.gap(sample) - kBothWays * surface_.bound() > ahead_) return true;
  if (!seen.any) return false;
  return kReliable * seen.distance - kBothWays * surface_.change_since(seen.when) > ahead_;
}

SelfSearch::Found SelfSearch::find(int sample, const Vector3& place, const Vector3& outward,
                                   double depth) noexcept {
  Seen& seen = seen_[static_cast<std::size_t>(sample)];
  const TriangleSet across = reach_.across(sample);
  // What it meets may move as far as the sample, and as far in the coming step.
  const double way = 2.0 * (place - seen.place).norm();
  Found found{surface_.closest_from(seen.nearest, place, across), {}};
  found.entry = surface_.first_crossing(place - (depth + way) * outward,
                                        place + (ahead_ + way) * outward, found.nearest, across);
  const SurfaceHit& nearest = found.nearest;
  const bool outside = (place - nearest.position).dot(surface_.normal(nearest.triangle)) > 0.0;
  seen = {nearest.triangle, true, place, outside && !found.entry ? nearest.signed_distance : 0.0,
          surface_.mark()};
  return found;
}

}  // namespace irdm
