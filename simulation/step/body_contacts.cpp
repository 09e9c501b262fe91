#include "simulation/step/body_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "simulation/contact/normal_cone.hpp"

namespace irdm {
namespace {

// Samples as near as this are given to the solver, which leaves them alone unless they come down.
constexpr double kNearBody = 1e-4;
// The same of parts of one body, by the samples' spacing: a force of this step bends both.
constexpr double kNearItself = 0.1;
// As those of the floor: how far a sample may be from where it would be at rest, to be looked at.
constexpr double kLeastReach = 2e-3;
constexpr double kReachFactor = 2.0;
constexpr double kReachFading = 0.99;
// A displacement by contacts at rest is at most about this share of its bound.
constexpr double kBoundShare = 0.25;
// Part of the samples' spacing by which their way begins inside their own object.
constexpr double kDepth = 0.5;
// How far beyond a way distances are seen, by that depth, and what of them is relied on.
constexpr double kSightDepths = 2.0;
constexpr double kReliable = 1.0 - 1e-9;
// Surfaces touch where their outward normals point at each other: cosine of their angle at most.
constexpr double kFacing = -0.3;
// An edge whose face is turned to the other's by a smaller angle than this lies flat: the samples
// of the face touch. Cosine, 3 degrees.
constexpr double kFlush = 0.9986;
// An edge leads on a face whose normal is as near as this to its own ones. Cosine, 20 degrees.
constexpr double kLeads = 0.94;
// How deep a sample that was outside can be at the start of a step, where it is displaced as at the
// end without the step's forces: by rounding [m], and as shares of what forces closed in the step
// before and of the displacements.
constexpr double kRoundedDepth = 1e-5;
constexpr double kClosedShare = 2.0;
constexpr double kDisplacedShare = 0.2;
// In which a sample that was inside when its contact began comes out, and one that yields comes to
// its anchor [s].
constexpr double kInsetTime = 0.05;
// A sample that comes back to its last anchor, as near as kNearBody sideways, after at most so many
// steps without force is bound to that anchor again.
constexpr std::uint64_t kBounceSteps = 3;

double ball_radius(const RestSurface& rest) noexcept {
  double largest = 0.0;
  for (int i = 0; i < rest.node_count(); ++i) largest = std::max(largest, rest.node(i).norm());
  return largest;
}

Vector3 sideways(const Vector3& v, const Vector3& normal) noexcept {
  return v - v.dot(normal) * normal;
}

// Where a point that moves with the body was at the start of the step, W.
Vector3 at_start(const FreeMotion& motion, const Vector3& place) noexcept {
  return motion.start.position + motion.start.orientation * place;
}

// Whether no part of the surface is flat.
bool is_round(const SceneryShape& shape) noexcept {
  return std::holds_alternative<SphereShape>(shape) || std::holds_alternative<CapsuleShape>(shape);
}

}  // namespace

BodyContacts::BodyContacts(int object, const ContactBody& body, int other,
                           const ContactBody& other_body, double dt, int first_sample)
    : object_(object),
      other_(other),
      body_(body),
      other_body_(&other_body),
      radius_(ball_radius(body.rest)),
      other_radius_(ball_radius(other_body.rest)),
      inset_left_(std::max(0.0, 1.0 - dt / kInsetTime)),
      depth_(kDepth * std::min(body.sampling.spacing(), other_body.sampling.spacing())),
      first_sample_(first_sample),
      samples_(body.sampling.samples().size()),
      found_(kMost) {
  candidates_.reserve(samples_.size());
  for (int i = 0; i < other_body.rest.node_count(); ++i) other_box_.extend(other_body.rest.node(i));
}

BodyContacts::BodyContacts(int object, const ContactBody& body, int scenery,
                           const SceneryStep& there, double dt)
    : object_(object),
      other_(-1 - scenery),
      body_(body),
      scenery_(&there),
      radius_(ball_radius(body.rest)),
      other_radius_(bounding_radius(there.now.shape)),
      inset_left_(std::max(0.0, 1.0 - dt / kInsetTime)),
      depth_(kDepth * body.sampling.spacing()),
      samples_(body.sampling.samples().size()),
      found_(kMost) {
  candidates_.reserve(samples_.size());
}

BodyContacts::BodyContacts(int object, const ContactBody& body, const SelfReach& reach, double dt)
    : BodyContacts(object, body, object, body, dt) {
  self_.emplace(reach, body.surface, kNearItself * body.sampling.spacing());
}

void BodyContacts::reset() noexcept {
  if (self_) self_->reset();
  clear_ = 0;
  std::fill(samples_.begin(), samples_.end(), Sample{});
  count_ = 0;
  displaced_ = 0.0;
  closed_ = 0.0;
  step_ = 1;
  any_pressed_ = false;
}

// Whether the balls round both meet.
bool BodyContacts::near() const noexcept {
  if (self_) return true;
  const Vector3& there =
      other_body_ != nullptr ? other_body_->motion.position : scenery_->now.position;
  const double reach = radius_ + other_radius_ + kLeastReach + kReachFactor * displaced_;
  const Vector3 way = body_.motion.position - body_.motion.start.position;
  const double moved =
      way.norm() + (other_body_ != nullptr
                        ? (other_body_->motion.position - other_body_->motion.start.position).norm()
                        : (scenery_->now.position - scenery_->before).norm());
  return (body_.motion.position - there).norm() <= reach + moved;
}

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
  const Vector3 x = at_start(body_.motion, place);
  return scenery_ != nullptr ? scenery_->carried(x) : x;
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

// Whether a face beside an edge sample lies on the other's; never on one that is round, where the
// samples of the face are away from the edge. @param normal of the other, B of the object
bool BodyContacts::flush(int sample, const Vector3& normal) const noexcept {
  if (sample < body_.sampling.first_edge()) return false;
  if (scenery_ != nullptr && is_round(scenery_->now.shape)) return false;
  const std::span<const Vector3> faces =
      body_.sampling.faces(body_.sampling.samples()[static_cast<std::size_t>(sample)]);
  return std::any_of(faces.begin(), faces.end(),
                     [&](const Vector3& face) { return -face.dot(normal) > kFlush; });
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
  if (!(kReliable * seen.distance - moved > 0.5 * way.length())) return false;
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
  if (!entry || entry->normal.dot(way.outward) > kFacing ||
      flush(sample, body_.motion.orientation.conjugate() * entry->normal)) {
    if (hit.signed_distance > 0.0) state.mark_outside(step_);
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
  state.inset = inset_of((state.anchor_W - way.start).dot(state.normal), state);
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
  if (flush(number, to_own * other_body_->sampling.normal(nearest))) {
    hit.reset();
  } else if (!self_) {
    hit = other_body_->surface.first_crossing(way.from, way.to, near);
  }
  if (!hit) {
    const Vector3 u = other_displacement(nearest);
    const Vector3 there_now = nearest.position + u;
    const Vector3 normal = other_body_->sampling.normal(nearest);
    if ((way.end - there_now).dot(normal) > 0.0) state.mark_outside(step_);
    if (!self_ && (way.middle() - there_now).norm() > 0.5 * way.length()) {
      const double limit = 0.5 * way.length() + kSightDepths * depth_;
      note(way, place, other_body_->surface.distance_up_to(limit, way.middle(), near),
           std::max(u.norm(), (place - sample.place.position).norm()), state);
    }
    return false;
  }
  state.anchor = {hit->triangle, hit->point,
                  at(other_body_->rest.corners(hit->triangle), hit->point.weights)};
  const std::optional<Vector3> normal = normal_at(number, direction, state.anchor);
  if (!normal || normal->dot(direction) > kFacing || flush(number, to_own * *normal)) return false;
  state.normal = *normal;
  const Vector3 there_now = state.anchor.position + other_displacement(state.anchor);
  state.offset = sideways(way.end - there_now, state.normal);
  state.inset = inset_of((there_now - way.start).dot(state.normal), state);
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

void BodyContacts::describe(int sample, const Vector3& place, Contact& contact) noexcept {
  const Sample& state = samples_[static_cast<std::size_t>(sample)];
  const ContactSampling::Sample& shape = body_.sampling.samples()[static_cast<std::size_t>(sample)];
  contact.sample = sample;
  contact.place = {{shape.row, 0, 0}, {1.0, 0.0, 0.0}, 1};
  contact.arm = place;
  const Vector3 x = body_.motion.to_world(place);
  if (other_body_ == nullptr) {
    contact.other_place.count = 0;
    contact.normal = state.normal;
    contact.gap = state.anchor_W - state.inset * state.normal - x;
    return;
  }
  contact.other_place = {other_body_->sampling.sites(state.anchor.triangle),
                         state.anchor.point.weights, 3};
  contact.other_arm = state.anchor.position + other_displacement(state.anchor) + state.offset -
                      state.inset * state.normal;
  contact.normal = other_body_->motion.orientation * state.normal;
  contact.gap = other_body_->motion.to_world(contact.other_arm) - x;
}

// Whether any of its samples may meet another part of the object.
bool BodyContacts::near_itself() noexcept {
  const bool any = self_->begin_step();
  if (!any) clear_ = step_;
  return any;
}

int BodyContacts::find() noexcept {
  count_ = 0;
  ++step_;
  displaced_ *= kReachFading;
  closed_ *= kReachFading;
  if (!(self_ ? near_itself() : near()) && !any_pressed_) return 0;
  candidates_.clear();
  const FreeMotion& motion = body_.motion;
  const double margin = kLeastReach + kReachFactor * std::max(displaced_, unseen());
  const std::span<const ContactSampling::Sample> shapes = body_.sampling.samples();
  const Quaternion normal_to_own =
      other_body_ == nullptr
          ? Quaternion(motion.orientation.conjugate())
          : Quaternion(motion.orientation.conjugate() * other_body_->motion.orientation);
  for (int i = first_sample_; i < static_cast<int>(shapes.size()); ++i) {
    const ContactSampling::Sample& shape = shapes[static_cast<std::size_t>(i)];
    Sample& state = samples_[static_cast<std::size_t>(i)];
    if (driven()) {
      state.anchor_W = scenery_->carried(state.anchor_W);
      state.normal = scenery_->turn * state.normal;
    }
    if (state.contact.any() && flush(i, normal_to_own * state.normal)) state.contact.end();
    const bool pressed = state.contact.any();
    if (!pressed) {
      const Vector3 x = motion.to_world(shape.place.position);
      const double way = (x - started(shape.place.position)).norm();
      if (self_ ? self_->is_far(i) : beyond(x, margin + way, state)) {
        state.mark_outside(step_);
        continue;
      }
      if (is_clear(i, state.seen)) {
        if (state.seen.outside) state.mark_outside(step_);
        continue;
      }
    }
    const Vector3 place = displaced_place(shape);
    if (!pressed) {
      const Sample before = state;
      if (!begin(i, place, state)) continue;
      keep_anchor(before, place, state);
    }
    candidates_.push_back({i, pressed, 0.0, place});
  }
  for (Candidate& candidate : candidates_) {
    Contact& contact = found_.front();
    describe(candidate.sample, candidate.place, contact);
    candidate.depth = contact.gap.dot(contact.normal);
    if (candidate.pressed) closed_ = std::max(closed_, candidate.depth);
  }
  if (candidates_.size() > kMost) {
    std::nth_element(candidates_.begin(), candidates_.begin() + kMost, candidates_.end(),
                     [](const Candidate& a, const Candidate& b) {
                       if (a.pressed != b.pressed) return a.pressed;
                       if (a.depth != b.depth) return a.depth > b.depth;
                       return a.sample < b.sample;
                     });
    candidates_.resize(kMost);
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.sample < b.sample; });
  }
  for (const Candidate& candidate : candidates_) {
    samples_[static_cast<std::size_t>(candidate.sample)].clear = step_;
    describe(candidate.sample, candidate.place, found_[static_cast<std::size_t>(count_++)]);
  }
  any_pressed_ = false;
  return count_;
}

void BodyContacts::pose(int i, const Friction& friction,
                        ContactConstraint& constraint) const noexcept {
  const Contact& contact = found_[static_cast<std::size_t>(i)];
  const Sample& state = samples_[static_cast<std::size_t>(contact.sample)];
  state.contact.pose(-contact.normal, friction, Vector3::Zero(), contact.gap, constraint);
  constraint.law = ContactLaw::kTouching;
  constraint.force = body_.motion.halfway * state.force;
}

void BodyContacts::update(int i, const ContactConstraint& solved, const Vector3& yielded) noexcept {
  const Contact& contact = found_[static_cast<std::size_t>(i)];
  Sample& state = samples_[static_cast<std::size_t>(contact.sample)];
  const bool pressed = solved.mode != ContactMode::kOpen;
  const bool slipping = solved.mode == ContactMode::kSlipping;
  state.contact.begin(pressed ? ContactState::kTouching : ContactState::kFree, slipping);
  state.force = body_.motion.halfway.conjugate() * solved.force;
  state.inset = inset_left_ * state.inset - (1.0 - inset_left_) * yielded.dot(contact.normal);
  if (pressed) state.pressed = step_;
  any_pressed_ = any_pressed_ || pressed;
  if (!slipping) return;
  if (other_body_ == nullptr) {
    const SceneryHit hit = closest(scenery_->now, state.anchor_W - solved.slip);
    if (hit.normal.dot(state.normal) < -kFacing) {  // it has come to another side
      state.contact.end();
      return;
    }
    state.anchor_W = hit.position;
    state.normal = hit.normal;
    return;
  }
  const FreeMotion& there = other_body_->motion;
  const Vector3 way = -(there.orientation.conjugate() * solved.slip);
  state.anchor = other_body_->rest.straight_on(state.anchor, way, way.norm());
  const ContactSampling::Sample& sample =
      body_.sampling.samples()[static_cast<std::size_t>(contact.sample)];
  const Vector3 outward =
      there.orientation.conjugate() * (body_.motion.orientation * sample.normal);
  const std::optional<Vector3> normal = normal_at(contact.sample, outward, state.anchor);
  if (!normal) {
    state.contact.end();
    return;
  }
  state.normal = *normal;
  state.offset = sideways(state.offset, state.normal);
  if (state.normal.dot(outward) > kFacing) state.contact.end();
}

void BodyContacts::write(int i, const ContactConstraint& solved,
                         BodyContactRecord& record) const noexcept {
  const Contact& contact = found_[static_cast<std::size_t>(i)];
  const Sample& state = samples_[static_cast<std::size_t>(contact.sample)];
  record.object = object_;
  record.other = other_;
  record.sample = contact.sample;
  record.slipping = solved.mode == ContactMode::kSlipping;
  record.triangle = state.anchor.triangle;
  record.weights = state.anchor.point.weights;
  record.force = solved.force;
  record.normal = contact.normal;
  record.slip = -solved.slip;
  record.area = body_.sampling.samples()[static_cast<std::size_t>(contact.sample)].area;
}

double BodyContacts::initial_depth() noexcept {
  if (self_) return 0.0;
  double deepest = 0.0;
  for (const ContactSampling::Sample& shape :
       body_.sampling.samples().subspan(static_cast<std::size_t>(first_sample_))) {
    const Vector3 x = at_start(body_.motion, shape.place.position);
    double distance = 0.0;
    if (other_body_ == nullptr) {
      distance = closest(scenery_->now, x).signed_distance;
    } else {
      const Vector3 y = other_body_->motion.start.orientation.conjugate() *
                        (x - other_body_->motion.start.position);
      if (!other_box_.contains(y)) continue;
      distance = other_body_->surface.closest(y).signed_distance;
    }
    deepest = std::max(deepest, -distance);
  }
  return deepest;
}

}  // namespace irdm
