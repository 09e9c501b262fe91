#include "simulation/step/god_object.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {
namespace {
// Cosines of 18 and 37 degrees, between the normals of two places of the surface: up to the first
// they count as one side of the object, from the second on as two.
constexpr double kSameSide = 0.95;
constexpr double kOtherSide = 0.8;
// Distance from the tip, compared to another place's, from which on a place is much nearer.
constexpr double kMuchNearer = 0.6;

// 0 up to `from`, 1 from `to` on.
double fading(double value, double from, double to) noexcept {
  return std::clamp((value - from) / (to - from), 0.0, 1.0);
}
}  // namespace

void GodObject::find(const Input& input, DeformedSurface& surface) noexcept {
  tip_moved_ = (input.tip - tip_).norm();
  tip_ = input.tip;
  fresh_ = false;
  if (!contact_.any() && !reach_for(input, surface)) touch(input.tip, surface);
  if (!contact_.any()) {
    grabbed_before_ = input.grab;
    return;
  }
  // What is touched goes on from where it is, and only what pushes is taken hold of (hence not in
  // the step in which it begins): so a grab makes no jump.
  if (input.grab && !fresh_) {
    contact_.hold();
  } else if (contact_.state() == ContactState::kHeld) {
    contact_.release();
  }
  grabbed_before_ = input.grab;
}

// A tip whose way crosses the surface from outside touches it there.
void GodObject::touch(const Vector3& tip, DeformedSurface& surface) noexcept {
  if (surface.is_far_from(outside_ ? last_tip_ : tip, tip)) {
    outside_ = true;
    last_tip_ = tip;
    return;
  }
  const SurfaceHit hit = surface.closest(tip);
  std::optional<SurfaceHit> entry;
  if (outside_) entry = surface.first_crossing(last_tip_, tip, hit);
  if (entry || (outside_ && hit.signed_distance <= 0)) {
    const SurfaceHit& at = entry ? *entry : hit;
    contact_.begin(ContactState::kTouching);
    triangle_ = at.triangle;
    point_ = at.point;
    offset_.setZero();
    fresh_ = true;
    reached_ = false;
  }
  if (hit.signed_distance > 0) outside_ = true;
  last_tip_ = tip;
}

// A button pressed near the surface takes hold of the nearest node at its offset.
bool GodObject::reach_for(const Input& input, DeformedSurface& surface) noexcept {
  if (!input.grab || grabbed_before_ || input.reach <= 0) return false;
  const SurfaceHit hit = surface.closest(input.tip);
  if (std::abs(hit.signed_distance) > input.reach) return false;
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (hit.point.weights[i] > hit.point.weights[nearest]) nearest = i;
  }
  contact_.begin(ContactState::kHeld);
  triangle_ = hit.triangle;
  point_.nodes = hit.point.nodes;
  point_.weights = {0.0, 0.0, 0.0};
  point_.weights[nearest] = 1.0;
  offset_ = input.tip - surface.node(hit.point.nodes[nearest]);
  reached_ = true;
  return true;
}

void GodObject::impose(ContactState state, const SurfacePoint& point) noexcept {
  contact_.begin(state);
  point_ = point;
  offset_.setZero();
  fresh_ = false;
  reached_ = false;
}

void GodObject::stay(const Vector3& slip, double share, const Vector3& point_free,
                     const RestSurface& rest) noexcept {
  const double length = slip.norm();
  contact_.set_slipping(length > 0.0);
  slid_ = catch_up(length, share);
  if (length > 0.0) slide(slip, slid_, rest);
  outside_ = true;
  last_tip_ = point_free;
}

double GodObject::catch_up(double length, double share) const noexcept {
  const double at_once = std::min(length, tip_moved_);
  return at_once + share * (length - at_once);
}

void GodObject::slide(const Vector3& towards, double length, const RestSurface& rest) noexcept {
  const Vector3 here = at(rest.corners(triangle_), point_.weights);
  const SurfaceLocation there = rest.straight_on({triangle_, point_, here}, towards, length);
  triangle_ = there.triangle;
  point_ = there.point;
}

void GodObject::follow(const Vector3& tip, double share, const RestSurface& rest) noexcept {
  const SurfaceLocation nearest = rest.walk(triangle_, tip);
  const Vector3 here = at(rest.corners(triangle_), point_.weights);
  const double cosine = rest.smooth_normal(nearest.point).dot(rest.smooth_normal(point_));
  const double ratio = (tip - nearest.position).norm() / (tip - here).norm();
  const double weight = fading(cosine, kSameSide, kOtherSide) * fading(ratio, 1.0, kMuchNearer);
  if (!(weight > 0.0)) return;
  const Vector3 way = nearest.position - here;
  const double length = weight * catch_up(way.norm(), share) - slid_;
  if (!(length > 0.0)) return;
  slide(way, length, rest);
  contact_.set_slipping(true);
}

void GodObject::reject_contact() noexcept {
  contact_.end();
  outside_ = false;
}

void GodObject::release(const Vector3& tip) noexcept {
  contact_.end();
  outside_ = true;
  last_tip_ = tip;
}

}  // namespace irdm
