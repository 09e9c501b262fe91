// How the samples of an object come to touch: which are far, which are clear, and where a contact
// begins.
#include <algorithm>
#include <cmath>
#include <variant>

#include "simulation/contact/normal_cone.hpp"
#include "simulation/step/body_contacts.hpp"

namespace irdm {
namespace {

// Samples as near as this are given to the solver, which leaves them alone unless they come down.
constexpr double kNearBody = 1e-4;
// How far beyond a way distances are seen, by that depth, and what of them is relied on.
constexpr double kSightDepths = 2.0;
constexpr double kCertain = 1.0 - 1e-9;
// An edge whose face is turned to the other's by a smaller angle than this lies flat: the samples
// of the face touch. Cosine, 3 degrees.
constexpr double kFlush = 0.9986;
// How deep an edge that lies flat may be before it touches as well [m]: the samples of the face
// leave it free up to their spacing, on a body that bends or comes to rest askew.
constexpr double kFlatInset = 2e-4;
// What comes down by more than this in a step [m] the face's samples stop, some of them at the same
// nodes: with the edges besides the sweeps find no solution.
constexpr double kFastestFlat = 2e-3;
// An edge leads on a face whose normal is as near as this to its own ones. Cosine, 20 degrees.
constexpr double kLeads = 0.94;
// How deep a sample that was outside can be at the start of a step, where it is displaced as at the
// end without the step's forces: by rounding [m], and as shares of what forces closed in the step
// before and of the displacements.
constexpr double kRoundedDepth = 1e-5;
constexpr double kClosedShare = 2.0;
constexpr double kDisplacedShare = 0.2;
// A sample that comes back to its last anchor, as near as kNearBody sideways, after at most so many
// steps without force is bound to that anchor again.
constexpr std::uint64_t kBounceSteps = 3;

// Whether no part of the surface is flat.
bool is_round(const SceneryShape& shape) noexcept {
  return std::holds_alternative<SphereShape>(shape) || std::holds_alternative<CapsuleShape>(shape);
}

}  // namespace

// Whether a point is farther than that from the other at rest: the distance changes by no more than
// the point moves, so that it need not be computed anew in each step.
bool BodyContacts::beyond(const Vector3& x, double reach, Sample& state) const noexcept {
  Vector3 place = x;
  if (other_body_ != nullptr) {
    place = other_body_->motion.to_body(x);
    if (other_box_.squaredExteriorDistance(place) > reach * reach) return true;
  }
  if (!driven()) {
    const double moved = (place - state.looked_at).norm();
    if (state.distance - moved > reach) return true;
    if (state.distance > 0.0 && state.distance + moved <= reach) return false;
  }
  state.looked_at = place;
  state.distance = look(place, state);
  return state.distance > reach;
}

// Distance from the other at rest [m]; inside an object 0.
double BodyContacts::look(const Vector3& place, Sample& state) const noexcept {
  if (other_body_ == nullptr) return closest(scenery_->now, place).signed_distance;
  const SurfaceLocation nearest = other_body_->rest.closest(place, state.nearest);
  state.nearest = nearest.triangle;
  const Vector3 way = place - nearest.position;
  return way.dot(other_body_->sampling.normal(nearest)) > 0.0 ? way.norm() : 0.0;
}

// Where a point that moves with the body was at the start of the step; beside scenery, carried
// along with that.
Vector3 BodyContacts::started(const Vector3& place) const noexcept {
  const FreeMotion& motion = body_.motion;
  const Vector3 x = motion.start.position + motion.start.orientation * place;
  return scenery_ != nullptr ? scenery_->moved(x) : x;
}

// How far surfaces may be displaced where none was looked at [m].
double BodyContacts::unseen() noexcept {
  double bound = body_.surface.bound();
  if (other_body_ != nullptr) bound = std::max(bound, other_body_->surface.bound());
  return std::isfinite(bound) ? kBoundShare * bound : 0.0;
}

Vector3 BodyContacts::displaced_place(const ContactSampling::Sample& sample) noexcept {
  const Vector3 u = mean(body_.sampling.patch(sample.row), [&](int i) -> Vector3 {
    return body_.surface.node(i) - body_.rest.node(i);
  });
  displaced_ = std::max(displaced_, u.norm());
  return sample.place.position + u;
}

Vector3 BodyContacts::other_displacement(const SurfaceLocation& at) noexcept {
  Vector3 u = Vector3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    if (at.point.weights[i] == 0.0) continue;
    const int site = other_body_->sampling.sites(at.triangle)[i];
    u += at.point.weights[i] * mean(other_body_->sampling.patch(site), [&](int node) -> Vector3 {
           return other_body_->surface.node(node) - other_body_->rest.node(node);
         });
  }
  displaced_ = std::max(displaced_, u.norm());
  return u;
}

// How deep an edge sample may be without touching because a face beside it lies on the other's [m].
// It grows continuously from 3 degrees on, so that the force of an edge that turns flat goes over
// to the samples of the face, and back. 0 on one that is round, where these are away from the edge.
// @param normal of the other, B of the object
double BodyContacts::flat_inset(int sample, const Vector3& normal) const noexcept {
  if (sample < body_.sampling.first_edge()) return 0.0;
  if (scenery_ != nullptr && is_round(scenery_->now.shape)) return 0.0;
  double flattest = kFlush;
  for (const Vector3& face :
       body_.sampling.faces(body_.sampling.samples()[static_cast<std::size_t>(sample)])) {
    flattest = std::max(flattest, -face.dot(normal));
  }
  return kFlatInset * (flattest - kFlush) / (1.0 - kFlush);
}

// Outward of the other where the sample touches it. An edge that meets a face takes the face's
// normal, a patch that meets an edge its own. None: an edge that meets no face, and a patch so near
// to a node of the other's edge that the edge sample there does what is needed (two contacts at one
// place have no unique forces). @param outward unit, of the sample, B of the other
std::optional<Vector3> BodyContacts::normal_at(int sample, const Vector3& outward,
                                               const SurfaceLocation& at) const noexcept {
  const ContactSampling& there = other_body_->sampling;
  const Vector3 normal = there.normal(at);
  if (-outward.dot(normal) > kFlush) return normal;
  const std::span<const Vector3> faces =
      body_.sampling.faces(body_.sampling.samples()[static_cast<std::size_t>(sample)]);
  if (!faces.empty()) {
    const Vector3 down =
        -(body_.motion.orientation.conjugate() * (other_body_->motion.orientation * normal));
    if (nearest_in_cone(faces, down).dot(down) > kLeads) return normal;
    if (sample >= body_.sampling.first_edge()) return std::nullopt;
  }
  const std::span<const Vector3> node = there.faces_near(at, depth_);
  if (!node.empty() && nearest_in_cone(node, -outward).dot(normal) < kFlush) return std::nullopt;
  return there.normal(at, -outward, depth_);
}

BodyContacts::Way BodyContacts::way_of(int sample, const Vector3& place) const noexcept {
  const FreeMotion& motion = body_.motion;
  Way way{.start = started(place),
          .end = motion.to_world(place),
          .outward = motion.orientation *
                     body_.sampling.samples()[static_cast<std::size_t>(sample)].normal,
          .from = {},
          .to = {}};
  if (other_body_ != nullptr) {
    const FreeMotion& there = other_body_->motion;
    way.start = there.start.orientation.conjugate() * (way.start - there.start.position);
    way.end = there.to_body(way.end);
    way.outward = there.orientation.conjugate() * way.outward;
  }
  way.from = way.start - depth_ * way.outward;
  way.to = way.end + kNearBody * way.outward;
  return way;
}

// Whether nothing of the other can have come into the way of a sample since it was seen.
bool BodyContacts::is_clear(int sample, const Sighting& seen) noexcept {
  if (!(seen.distance > 0.0)) return false;
  double change = body_.surface.change_since(seen.own);
  if (other_body_ != nullptr) change += other_body_->surface.change_since(seen.other);
  const Way way = way_of(sample, seen.place);
  const double moved = (way.middle() - seen.middle).norm() + std::sqrt(3.0) * change;
  if (!(kCertain * seen.distance - moved > 0.5 * way.length())) return false;
  body_.surface.keep();
  if (other_body_ != nullptr) other_body_->surface.keep();
  displaced_ = std::max(displaced_, seen.displaced);
  return true;
}

void BodyContacts::note(const Way& way, const Vector3& place, double distance, double displaced,
                        Sample& state) const noexcept {
  state.seen = {distance,
                place,
                way.middle(),
                body_.surface.mark(),
                other_body_ != nullptr ? other_body_->surface.mark() : DeformedSurface::Mark{},
                displaced,
                state.clear == step_};
}

bool BodyContacts::begin_on_scenery(int sample, const Vector3& place, const Way& way,
                                    Sample& state) noexcept {
  const SceneryHit hit = closest(scenery_->now, way.end);
  const std::optional<SceneryHit> entry = first_crossing(scenery_->now, way.from, way.to);
  const bool facing = entry && entry->normal.dot(way.outward) <= kFacing;
  state.flat_inset =
      facing ? flat_inset(sample, body_.motion.orientation.conjugate() * entry->normal) : 0.0;
  const double above = hit.signed_distance + state.flat_inset;
  if (!facing || (state.flat_inset > 0.0 && above > kNearBody)) {
    if (above > 0.0) state.mark_outside(step_);
    if (!driven()) {
      note(way, place, closest(scenery_->now, way.middle()).signed_distance, displaced_, state);
    }
    return false;
  }
  const bool same_side = hit.normal.dot(way.outward) <= kFacing;
  state.normal = same_side ? hit.normal : entry->normal;
  state.anchor_W =
      same_side ? hit.position
                : Vector3(way.end - (way.end - entry->position).dot(entry->normal) * entry->normal);
  state.inset = inset_of((state.anchor_W - way.start).dot(state.normal) - state.flat_inset, state);
  return true;
}

// Sideways nothing is wanted in the step in which it begins.
bool BodyContacts::begin(int number, const Vector3& place, Sample& state) noexcept {
  const ContactSampling::Sample& sample =
      body_.sampling.samples()[static_cast<std::size_t>(number)];
  const Way way = way_of(number, place);
  state.seen.distance = 0.0;
  if (other_body_ == nullptr) return begin_on_scenery(number, place, way, state);
  const Vector3& direction = way.outward;
  const Quaternion to_own = body_.motion.orientation.conjugate() * other_body_->motion.orientation;
  SurfaceLocation nearest;
  std::optional<SurfaceHit> hit;
  if (self_) {
    const SelfSearch::Found found = self_->find(number, place, sample.normal, depth_);
    nearest = {found.nearest.triangle, found.nearest.point,
               at(body_.rest.corners(found.nearest.triangle), found.nearest.point.weights)};
    hit = found.entry;
  } else {
    nearest = other_body_->rest.closest(way.end, state.nearest);
    state.nearest = nearest.triangle;
  }
  const SurfaceHit near{nearest.triangle, nearest.point, nearest.position, 0.0};
  const Vector3 face = other_body_->sampling.normal(nearest);
  state.flat_inset = flat_inset(number, to_own * face);
  const Vector3 u = other_displacement(nearest);
  const Vector3 nearest_now = nearest.position + u;
  const double above = (way.end - nearest_now).dot(face) + state.flat_inset;
  if (state.flat_inset > 0.0 && above > kNearBody) {
    hit.reset();
  } else if (!self_) {
    hit = other_body_->surface.first_crossing(way.from, way.to, near);
  }
  if (!hit) {
    if (above > 0.0) state.mark_outside(step_);
    if (!self_ && (way.middle() - nearest_now).norm() > 0.5 * way.length()) {
      const double limit = 0.5 * way.length() + kSightDepths * depth_;
      note(way, place, other_body_->surface.distance_up_to(limit, way.middle(), near),
           std::max(u.norm(), (place - sample.place.position).norm()), state);
    }
    return false;
  }
  state.anchor = {hit->triangle, hit->point,
                  at(other_body_->rest.corners(hit->triangle), hit->point.weights)};
  const std::optional<Vector3> normal = normal_at(number, direction, state.anchor);
  if (!normal || normal->dot(direction) > kFacing) return false;
  state.normal = *normal;
  state.flat_inset = flat_inset(number, to_own * state.normal);
  const Vector3 there_now = state.anchor.position + other_displacement(state.anchor);
  const double depth = (there_now - way.start).dot(state.normal) - state.flat_inset;
  const double down = (way.start - way.end).dot(state.normal);
  if (state.flat_inset > 0.0 && depth < 0.0 && down > kFastestFlat) return false;
  state.offset = sideways(way.end - there_now, state.normal);
  state.inset = inset_of(depth, state);
  return true;
}

// Of a contact that begins. A sample that was outside and is deeper than deformation explains comes
// from beside an edge.
// @param depth at the start of the step [m]
double BodyContacts::inset_of(double depth, const Sample& state) const noexcept {
  const bool outside = std::max(state.clear, clear_) + 1 == step_;
  const double deformed = kRoundedDepth + kClosedShare * closed_ + kDisplacedShare * displaced_;
  // What is beside an edge of the object itself was not marked.
  return !outside || (!self_ && depth > deformed) ? std::max(0.0, depth) : 0.0;
}

// A bounce that the step does not resolve. With a new anchor friction would not know the way that
// the sample slips in it, and a body that rests could go on so for ever.
// @param before what begin() has found `state` as
void BodyContacts::keep_anchor(const Sample& before, const Vector3& place, Sample& state) noexcept {
  if (before.pressed == 0 || before.pressed + kBounceSteps < step_) return;
  Vector3 way = body_.motion.to_world(place) - before.anchor_W;
  if (other_body_ != nullptr) {
    way = other_body_->motion.to_body(body_.motion.to_world(place)) - before.anchor.position -
          other_displacement(before.anchor) - before.offset;
  }
  if (sideways(way, before.normal).norm() > kNearBody) return;
  state.anchor = before.anchor;
  state.offset = before.offset;
  state.anchor_W = before.anchor_W;
  state.normal = before.normal;
}

}  // namespace irdm
