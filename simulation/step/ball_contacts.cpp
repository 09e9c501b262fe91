#include "simulation/step/ball_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace irdm {
namespace {

// Largest distance from the ball's surface at which a sample is evaluated, besides the ball's way
// in the step [m].
constexpr double kSearchDistance = 2e-3;
// Largest distance from the ball, without forces, at which a sample becomes a contact [m].
constexpr double kContactDistance = 1e-4;
// Largest depth in the last step of a sample that counts as coming from outside [m].
constexpr double kMaxOutsideDepth = 1e-5;
// Number of the first step, as find() counts.
constexpr std::uint64_t kFirstStep = 2;

}  // namespace

BallContacts::BallContacts(int object, const ContactBody& body, const PatchCompliance& compliance,
                           int ball, const SceneryStep& there, double dt)
    : ContactPair(object, ball),
      body_(body),
      compliance_(compliance),
      scenery_(there),
      radius_(std::get<SphereShape>(there.now.shape).radius),
      body_radius_(body.rest.bounding_radius()),
      inset_left_(std::max(0.0, 1.0 - dt / kInsetTime)) {
  range_ = body.sampling.ball(radius_);
  const auto count = static_cast<std::size_t>(range_.count);
  const auto nodes = static_cast<std::size_t>(body.rest.node_count());
  samples_.resize(count);
  used_.reserve(count);
  near_.reserve(count);
  candidates_.reserve(count);
  pressed_.reserve(count);
  pressed_now_.reserve(count);
  loaded_.reserve(nodes);
  load_.assign(nodes, Vector3::Zero());
  loaded_in_.assign(nodes, 0);
  shifted_in_.assign(nodes, 0);
  shift_.resize(nodes);
  make_faces();
}

void BallContacts::make_faces() {
  for (int i = 0; i < range_.count;) {
    Face face{i, 0, Vector3::Zero(), 0.0};
    for (; i < range_.count && shape(i).face == shape(face.first).face; ++i) {
      face.middle += shape(i).place.position;
      ++face.count;
    }
    face.middle /= face.count;
    for (int j = face.first; j < i; ++j) {
      face.radius = std::max(face.radius, (shape(j).place.position - face.middle).norm());
    }
    faces_.push_back(face);
  }
}

void BallContacts::reset() noexcept {
  for (const int i : used_) samples_[static_cast<std::size_t>(i)] = Sample{};
  used_.clear();
  count_ = 0;
  displaced_ = 0.0;
  step_ = 1;
  friction_.setZero();
  slipping_ = false;
  pressed_now_.clear();
  forget_steps();
}

void BallContacts::forget_steps() noexcept {
  std::fill(loaded_in_.begin(), loaded_in_.end(), 0);
  std::fill(shifted_in_.begin(), shifted_in_.end(), 0);
}

void BallContacts::archive(StateArchive& state) {
  state.value(displaced_);
  state.value(step_);
  state.value(friction_);
  state.value(slipping_);
  if (state.reading()) {
    for (const int i : used_) samples_[static_cast<std::size_t>(i)] = Sample{};
    count_ = 0;
    forget_steps();
    pressed_now_.clear();
  }
  state.list(used_);
  if (state.reading()) {
    std::erase_if(used_, [&](int i) { return i < 0 || i >= range_.count; });
  }
  for (const int i : used_) {
    Sample& sample = samples_[static_cast<std::size_t>(i)];
    state.value(sample);
    if (state.reading() && sample.pressed == step_) pressed_now_.push_back(i);
  }
}

bool BallContacts::near() const noexcept {
  if (!scenery_.present) return false;
  const FreeMotion& motion = body_.motion;
  const double moved = (motion.position - motion.start.position).norm() +
                       (scenery_.now.position - scenery_.before).norm();
  const double reach = body_radius_ + radius_ + kLeastReach + kReachFactor * displaced_;
  return (motion.position - scenery_.now.position).norm() <= reach + moved;
}

Vector3 BallContacts::displaced_place(const BallSample& shape) noexcept {
  Vector3 place = Vector3::Zero();
  for (std::size_t k = 0; k < shape.node_count; ++k) {
    place += shape.weights[k] * body_.surface.node(shape.nodes[k]);
  }
  return place;
}

// Finds the samples near the ball.
void BallContacts::collect_near(const BallWay& ball) noexcept {
  const Vector3& centre = ball.centre;
  near_.clear();
  const double bound = body_.surface.bound();
  const double unseen = std::isfinite(bound) ? kBoundShare * bound : 0.0;
  const double reach =
      radius_ + kLeastReach + ball.way + kReachFactor * std::max(displaced_, unseen);
  const double limit = kSearchDistance + ball.way;
  for (const int i : pressed_) look_at(i, centre, limit);
  for (const Face& face : faces_) {
    if ((face.middle - centre).norm() - face.radius > reach) continue;
    for (int i = face.first; i < face.first + face.count; ++i) {
      if (!may_be_near(i, centre, reach, limit)) continue;
      look_at(i, centre, limit);
    }
  }
}

// Returns false if an earlier evaluation proves that a sample without a force is farther than
// `limit` [m] from the ball's surface. @param reach largest distance of its rest position from
// `centre` [m]
bool BallContacts::may_be_near(int sample, const Vector3& centre, double reach,
                               double limit) noexcept {
  const Sample& state = samples_[static_cast<std::size_t>(sample)];
  if (is_pressed(state)) return false;
  if ((shape(sample).place.position - centre).squaredNorm() > reach * reach) return false;
  if (!state.seen) return true;
  const double moved =
      (centre - state.seen_from).norm() + std::sqrt(3.0) * body_.surface.change_since(state.mark);
  if (state.distance - moved <= limit) return true;
  body_.surface.keep();
  displaced_ = std::max(displaced_, state.displaced);
  return false;
}

void BallContacts::look_at(int sample, const Vector3& centre, double limit) noexcept {
  Sample& state = samples_[static_cast<std::size_t>(sample)];
  const Vector3 place = displaced_place(shape(sample));
  if (!state.seen) used_.push_back(sample);
  state.seen = true;
  state.seen_from = centre;
  state.mark = body_.surface.mark();
  state.distance = (place - centre).norm() - radius_;
  state.displaced = (place - shape(sample).place.position).norm();
  displaced_ = std::max(displaced_, state.displaced);
  if (is_pressed(state) || state.distance <= limit) near_.push_back({sample, place});
}

// Distributes the forces of the last step to the nodes.
void BallContacts::collect_forces() noexcept {
  loaded_.clear();
  for (const int i : pressed_) {
    const BallSample& shape = this->shape(i);
    for (std::size_t k = 0; k < shape.node_count; ++k) {
      const auto node = static_cast<std::size_t>(shape.nodes[k]);
      if (loaded_in_[node] != step_) {
        loaded_in_[node] = step_;
        load_[node].setZero();
        loaded_.push_back(shape.nodes[k]);
      }
      load_[node] += shape.weights[k] * samples_[static_cast<std::size_t>(i)].force;
    }
  }
}

// Returns the displacement of a node within the step by the last step's forces [m], B.
const Vector3& BallContacts::shift_of(int node) noexcept {
  const auto index = static_cast<std::size_t>(node);
  if (shifted_in_[index] == step_) return shift_[index];
  shifted_in_[index] = step_;
  shift_[index].setZero();
  for (const int loaded : loaded_) {
    shift_[index] += compliance_.at_node(node, body_.sampling.node_place(loaded)) *
                     load_[static_cast<std::size_t>(loaded)];
  }
  return shift_[index];
}

// Returns the same displacement of a sample, without near field.
Vector3 BallContacts::mesh_shift(const BallSample& shape) noexcept {
  Vector3 moved = Vector3::Zero();
  for (std::size_t k = 0; k < shape.node_count; ++k) {
    moved += shape.weights[k] * shift_of(shape.nodes[k]);
  }
  return moved;
}

// Returns the displacement of a sample by the near field of the last step's forces, along its
// normal [m].
double BallContacts::near_field_shift(int sample) const noexcept {
  double sum = 0.0;
  for (const int i : pressed_) {
    const Vector3& force = samples_[static_cast<std::size_t>(i)].force;
    sum += compliance_.near_field(range_.first + sample, range_.first + i) *
           force.dot(shape(i).normal);
  }
  return sum;
}

// Returns the outward normal of the sample's triangle in the reference state, not normalised, B.
Vector3 BallContacts::reference_normal(const BallSample& shape) noexcept {
  TriangleCorners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const int node = shape.place.point.nodes[k];
    corners[k] = body_.surface.node(node) + shift_of(node);
  }
  return area_normal(corners);
}

// Evaluates a sample in the reference state. Returns whether it is a candidate for a contact.
bool BallContacts::evaluate(const Near& near, const BallWay& ball, Candidate& candidate) noexcept {
  Sample& state = samples_[static_cast<std::size_t>(near.sample)];
  const BallSample& shape = this->shape(near.sample);
  const bool pressed = is_pressed(state);
  Vector3 moved = mesh_shift(shape);
  // A sample that does not touch yet faces the ball if the ball was on its outer side at the start.
  const Vector3 face = pressed ? Vector3::Zero() : reference_normal(shape);
  const bool faces = pressed || (near.place + moved - ball.before).dot(face) < 0.0;
  if (faces) moved += near_field_shift(near.sample) * shape.normal;
  const Vector3 place = near.place + moved;
  const Vector3 outward = contact_normal(place, face, ball);
  const double depth = radius_ - outward.dot(place - ball.centre);
  const double depth_before = state.depth;
  const bool listed = state.listed + 1 == step_;
  const bool known = state.looked + 1 == step_ || step_ == kFirstStep;
  state.looked = step_;
  state.depth = depth;
  if (!faces || outward.isZero(0.0)) return false;
  const FreeMotion& motion = body_.motion;
  state.normal = motion.orientation * outward;
  const double free_depth = depth + outward.dot(moved) + state.normal.dot(scenery_.recoil);
  if (pressed) {
    state.anchor = scenery_.carried(state.anchor);
  } else {
    state.force.setZero();
    state.push = 0.0;
    if (depth < -kSearchDistance - ball.way || free_depth < -kContactDistance) return false;
    const double inside = step_ == kFirstStep ? depth : depth_before;
    if (!listed) state.inset = known && inside > kMaxOutsideDepth ? inside : 0.0;
    state.anchor = scenery_.now.position + radius_ * state.normal;
  }
  state.listed = step_;
  state.gap = (free_depth - state.inset) * state.normal +
              sideways(state.anchor + scenery_.recoil - motion.to_world(near.place), state.normal);
  candidate = {near.sample, false, free_depth, place};
  return true;
}

// Returns the direction from the ball's centre to a point of the surface [unit, B]. Where the
// ball's centre passes through the face in this step, it is the direction at the time of impact.
// @param face outward normal of the face, not normalised; zero if the point is pressed already
Vector3 BallContacts::contact_normal(const Vector3& place, const Vector3& face,
                                     const BallWay& ball) const noexcept {
  const Vector3 away = place - ball.centre;
  const double distance = away.norm();
  if (distance > 0.0 && away.dot(face) <= 0.0) return away / distance;
  const Vector3 first = place - ball.before;
  if (first.norm() <= radius_) return first.normalized();
  // |first - t d| = R for the smallest t >= 0, which exists if the way comes near enough.
  const Vector3 d = ball.centre - ball.before;
  const double along = first.dot(d);
  const double root = along * along - d.squaredNorm() * (first.squaredNorm() - radius_ * radius_);
  if (root < 0.0 || along <= 0.0) return Vector3::Zero();
  return (first - (along - std::sqrt(root)) / d.squaredNorm() * d).normalized();
}

// Contacts that the world left out because a step had too many keep their state.
void BallContacts::keep_left_out() noexcept {
  for (int i = 0; i < count_; ++i) {
    if (samples_[static_cast<std::size_t>(number_of(contact(i)))].updated != step_) skip(i);
  }
  std::sort(pressed_now_.begin(), pressed_now_.end());
}

// A contact without a solution keeps its force as the reference for the next step: without it the
// surface has sprung back through the ball, and a deep contact would be lost.
void BallContacts::skip(int i) noexcept {
  const int sample = number_of(contact(i));
  Sample& state = samples_[static_cast<std::size_t>(sample)];
  state.updated = step_;
  if (is_pressed(state)) {
    state.pressed = step_;
    pressed_now_.push_back(sample);
  } else {
    state.listed = 0;
  }
}

int BallContacts::find() noexcept {
  keep_left_out();
  count_ = 0;
  ++step_;
  displaced_ *= kReachFading;
  std::swap(pressed_, pressed_now_);
  pressed_now_.clear();
  if (!near() && pressed_.empty()) return 0;
  const FreeMotion& motion = body_.motion;
  const Vector3 centre = motion.to_body(scenery_.now.position);
  const Vector3 before =
      motion.start.orientation.conjugate() * (scenery_.before - motion.start.position);
  const BallWay ball{before, centre, (centre - before).norm()};
  collect_near(ball);
  collect_forces();
  candidates_.clear();
  std::sort(near_.begin(), near_.end(),
            [](const Near& a, const Near& b) { return a.sample < b.sample; });
  for (const Near& near : near_) {
    Candidate candidate;
    if (evaluate(near, ball, candidate)) candidates_.push_back(candidate);
  }
  choose(candidates_);
  for (const Candidate& candidate : candidates_) {
    const Sample& state = samples_[static_cast<std::size_t>(candidate.sample)];
    Contact& contact = found_[static_cast<std::size_t>(count_++)];
    contact.sample = body_.sampling.first_ball() + range_.first + candidate.sample;
    contact.place = body_.sampling.place(contact.sample);
    contact.other_place.count = 0;
    contact.arm = candidate.place;
    contact.normal = state.normal;
    contact.gap = state.gap;
  }
  if (pressed_.empty()) {  // it begins to touch
    friction_.setZero();
    slipping_ = false;
  }
  return count_;
}

void BallContacts::pose(int i, const Friction& friction,
                        ContactConstraint& constraint) const noexcept {
  const Contact& contact = found_[static_cast<std::size_t>(i)];
  const Sample& state = samples_[static_cast<std::size_t>(number_of(contact))];
  constraint.law = ContactLaw::kTouching;
  constraint.normal = -contact.normal;
  constraint.friction = friction;
  constraint.gap = contact.gap;
  constraint.force = state.push * contact.normal;
}

// As the contacts pressed in the last step: where they press now is not known before.
double BallContacts::friction_weight(int i) const noexcept {
  const Contact& contact = found_[static_cast<std::size_t>(i)];
  return samples_[static_cast<std::size_t>(number_of(contact))].push;
}

void BallContacts::pose_friction(const Friction& friction,
                                 ContactConstraint& constraint) const noexcept {
  constraint.friction = friction;
  if (slipping_) constraint.friction.static_ = friction.kinetic;
  constraint.force = body_.motion.halfway * friction_;
}

void BallContacts::take_friction(const ContactConstraint& solved) noexcept {
  friction_ = body_.motion.halfway.conjugate() * solved.force;
  slipping_ = solved.mode == ContactMode::kSlipping;
}

void BallContacts::update(int i, const ContactConstraint& solved, const Vector3& yielded) noexcept {
  const Contact& contact = found_[static_cast<std::size_t>(i)];
  Sample& state = samples_[static_cast<std::size_t>(number_of(contact))];
  state.updated = step_;
  state.push = std::max(0.0, (solved.force - solved.shared).dot(contact.normal));
  const bool pressed = state.push > 0.0;
  state.force = body_.motion.halfway.conjugate() * solved.force;
  state.inset = inset_left_ * state.inset - (1.0 - inset_left_) * yielded.dot(contact.normal);
  if (pressed) {
    state.pressed = step_;
    pressed_now_.push_back(number_of(contact));
  }
  Vector3 moved = solved.apart;
  if (solved.mode == ContactMode::kSlipping) moved += solved.slip;
  if (moved.isZero(0.0)) return;
  const Vector3 arm = state.anchor - moved - scenery_.now.position;
  if (arm.isZero(0.0)) return;
  state.anchor = scenery_.now.position + radius_ * arm.normalized();
}

void BallContacts::write(int i, const ContactConstraint& solved,
                         BodyContactRecord& record) const noexcept {
  const Contact& contact = found_[static_cast<std::size_t>(i)];
  const BallSample& shape = this->shape(number_of(contact));
  record.object = object();
  record.other = other();
  record.sample = contact.sample;
  record.slipping = solved.mode == ContactMode::kSlipping;
  record.force = solved.force;
  record.normal = contact.normal;
  record.slip = -solved.slip;
  record.area = shape.area;
}

double BallContacts::initial_depth() noexcept {
  const Vector3 centre = body_.motion.start.orientation.conjugate() *
                         (scenery_.now.position - body_.motion.start.position);
  return std::max(0.0, radius_ - body_.surface.closest(centre).signed_distance);
}

}  // namespace irdm
