#include "simulation/step/body_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {
namespace {

// Parts of one body as near as this, by the samples' spacing, are given to the solver: a force of
// this step bends both.
// Distance below the surface at which two bodies are looked for that begin in one place [m].
constexpr double kInside = 1e-3;
constexpr double kNearItself = 0.1;
// Part of the samples' spacing by which their way begins inside their own object.
constexpr double kDepth = 0.5;

}  // namespace

BodyContacts::BodyContacts(int object, const ContactBody& body, int other,
                           const ContactBody& other_body, double dt, int first_sample)
    : ContactPair(object, other),
      body_(body),
      other_body_(&other_body),
      radius_(body.rest.bounding_radius()),
      other_radius_(other_body.rest.bounding_radius()),
      inset_left_(std::max(0.0, 1.0 - dt / kInsetTime)),
      depth_(kDepth * std::min(body.sampling.spacing(), other_body.sampling.spacing())),
      first_sample_(first_sample),
      samples_(body.sampling.samples().size()) {
  candidates_.reserve(samples_.size());
  for (int i = 0; i < other_body.rest.node_count(); ++i) other_box_.extend(other_body.rest.node(i));
}

BodyContacts::BodyContacts(int object, const ContactBody& body, int other, const SceneryStep& there,
                           double dt)
    : ContactPair(object, other),
      body_(body),
      scenery_(&there),
      radius_(body.rest.bounding_radius()),
      other_radius_(bounding_radius(there.now.shape)),
      inset_left_(std::max(0.0, 1.0 - dt / kInsetTime)),
      depth_(kDepth * body.sampling.spacing()),
      samples_(body.sampling.samples().size()) {
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
  if (scenery_ != nullptr && !scenery_->present) return false;
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

void BodyContacts::describe(int sample, const Vector3& place, Contact& contact) noexcept {
  const Sample& state = samples_[static_cast<std::size_t>(sample)];
  contact.sample = sample;
  contact.place = body_.sampling.place(sample);
  contact.arm = place;
  const double inset = state.inset + state.flat_inset;
  const Vector3 x = body_.motion.to_world(place);
  if (other_body_ == nullptr) {
    contact.other_place.count = 0;
    contact.normal = state.normal;
    contact.gap = state.anchor_W + scenery_->recoil - inset * state.normal - x;
    return;
  }
  contact.other_place = other_body_->sampling.place(state.anchor);
  contact.other_arm = state.anchor.position + other_displacement(state.anchor) + state.offset -
                      inset * state.normal;
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
    const bool pressed = state.contact.any();
    if (pressed) {
      state.flat_inset = flat_inset(i, normal_to_own * state.normal);
    } else {
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
  choose(candidates_);
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
  record.object = object();
  record.other = other();
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
  // Depth in the other one of a point of this body, B; 0 outside.
  const auto depth = [this](const Vector3& point) {
    const Vector3 x = body_.motion.start.position + body_.motion.start.orientation * point;
    if (other_body_ == nullptr) return std::max(0.0, -closest(scenery_->now, x).signed_distance);
    const Vector3 y = other_body_->motion.start.orientation.conjugate() *
                      (x - other_body_->motion.start.position);
    if (!other_box_.contains(y)) return 0.0;
    return std::max(0.0, -other_body_->surface.closest(y).signed_distance);
  };
  const auto inner_depth = [&](const Vector3& point) {
    return body_.surface.closest(point).signed_distance < 0.0 ? depth(point) : 0.0;
  };
  double deepest = 0.0;
  for (const ContactSampling::Sample& shape :
       body_.sampling.samples().subspan(static_cast<std::size_t>(first_sample_))) {
    deepest = std::max(deepest, depth(shape.place.position));
    // Surfaces that coincide hold no point of each other, their insides do.
    if (other_body_ == nullptr) continue;
    deepest = std::max(deepest, inner_depth(shape.place.position - kInside * shape.normal));
  }
  if (other_body_ != nullptr) deepest = std::max(deepest, inner_depth(Vector3::Zero()));
  return deepest;
}

}  // namespace irdm
