#include "device_bridge/contact/contact_predictor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/contact/applied_forces.hpp"
#include "common/contact/contact_problem.hpp"

namespace irdm {
namespace {

// What a contact that only pushes can exert of a force on the object.
Vector3 within_cone(const Vector3& force, const Vector3& outward, double friction) noexcept {
  const double push = -force.dot(outward);
  if (push <= 0.0) return Vector3::Zero();
  if (std::isinf(friction)) return force;
  const Vector3 along = force + push * outward;
  const double most = friction * push;
  const double length = along.norm();
  return length > most ? Vector3(most / length * along - push * outward) : force;
}

Vector3 sideways(const Vector3& v, const Vector3& normal) noexcept {
  return v - v.dot(normal) * normal;
}

}  // namespace

// Where nothing can be touched, nothing is predicted for any longer.
bool ContactPredictor::reaches(std::uint64_t k) const noexcept {
  const int horizon = model_.valid ? model_.horizon : kMaxHorizon;
  return any_ && k > model_.step && k - model_.step <= static_cast<std::uint64_t>(horizon);
}

bool ContactPredictor::missing(std::uint64_t step) const noexcept {
  if (step > model_.step) return true;
  const std::uint64_t age = model_.step - step;
  return age < kKept && (model_.missing >> age & 1) != 0;
}

// The model's motion, with the forces that it lacks.
void ContactPredictor::start_motion() noexcept {
  motion_ = model_.motion;
  moved_to_ = model_.step;
  const Vector3 spin = body_->angular_velocity(model_.motion);
  for (std::uint64_t age = 0; age < kKept && age <= model_.step; ++age) {
    const std::uint64_t i = model_.step - age;
    if (!missing(i) || past(i).step != i) continue;
    Past& late = past(i);
    const double ago = model_.dt * (static_cast<double>(age) + 0.5);
    const Quaternion Q = rotation_from_vector(-ago * spin) * model_.motion.orientation;
    late.force_B = Q.conjugate() * late.force;
    motion_ = body_->with_past(motion_, late.force, Q * late.arm.cross(late.force_B),
                               static_cast<int>(age));
  }
}

// Goes on with the motion to the end of step k, under our forces.
void ContactPredictor::move_to(std::uint64_t k) noexcept {
  for (; moved_to_ < k; ++moved_to_) {
    const FreeMotion free = free_motion(*body_, model_.free_forces, motion_);
    const Quaternion& Q = free.halfway;
    Vector3 force = model_.other_force;
    Vector3 torque = model_.other_torque;
    Past& ours = past(moved_to_ + 1);
    if (ours.step == moved_to_ + 1) {
      ours.force_B = Q.conjugate() * ours.force;
      force += ours.force_B;
      torque += ours.arm.cross(ours.force_B);
    }
    motion_ = end_of_step(*body_, model_.free_forces, free, Q * force, Q * torque);
  }
}

// Where the model's place is at the end of step k under the forces up to step k - 1 [m], B.
Vector3 ContactPredictor::surface_at(std::uint64_t k) const noexcept {
  Vector3 place = model_.place + model_.path[k - model_.step - 1];
  const auto horizon = static_cast<std::uint64_t>(model_.horizon);
  for (std::uint64_t age = 1; age < horizon && age <= k; ++age) {
    const std::uint64_t i = k - age;
    if (past(i).step == i && missing(i)) place += model_.response[age] * past(i).force_B;
  }
  return place;
}

void ContactPredictor::receive(const ContactModel& model) noexcept {
  if (any_ && model.step <= model_.step) return;
  any_ = true;
  model_ = model;
  if (!model_.valid) return end_contact();
  body_.emplace(model_.body, model_.dt);
  start_motion();
  place_anew();
}

// What the server does not know of our contact yet, expressed on its newest model.
void ContactPredictor::place_anew() noexcept {
  const bool before_ours = model_.step < began_;  // the model is older than our contact
  const bool held = model_.state == ContactState::kHeld;
  if (held != (contact_.state() == ContactState::kHeld)) end_contact();
  if (held) return contact_.hold();
  if (model_.state == ContactState::kFree && !before_ours) return end_contact();
  if (!contact_.any()) return;
  offset_.setZero();
  if (before_ours) {
    offset_ = sideways(last_place_ - model_.place, model_.normal);
    return;
  }
  // The server knows how far the tip had come in the last step that it has heard of.
  std::uint64_t heard = model_.step;
  while (heard > 0 && model_.step - heard < kMaxHorizon && missing(heard)) --heard;
  for (std::uint64_t i = heard + 1; i <= last_step_ && i - heard < kKept; ++i) {
    if (past(i).step == i) offset_ += past(i).slip;
  }
}

void ContactPredictor::end_contact() noexcept {
  contact_.end();
  offset_.setZero();
}

// Whether there is a touch in this step; it begins straight below the tip, no deeper than the tip
// can have come in the step.
bool ContactPredictor::touch(std::uint64_t k, const Vector3& from_surface, double way) noexcept {
  if (!contact_.any()) {
    const double depth = -from_surface.dot(model_.normal);
    if (depth <= 0.0) return false;
    // What the server touches already has a place.
    const bool known = model_.state == ContactState::kTouching;
    if (!known && depth > way + kDeepestStart) return false;
    contact_.begin(ContactState::kTouching, known && model_.slipping);
    began_ = known ? 0 : k;
    offset_ = known ? Vector3::Zero() : sideways(from_surface, model_.normal);
  }
  return true;
}

// Of the force of a contact that was there before a silence.
double ContactPredictor::share(std::uint64_t k) noexcept {
  const bool contact = contact_.any() || model_.state != ContactState::kFree;
  if (std::exchange(silent_, false) && contact) back_ = k;
  if (!contact) back_.reset();
  return back_ ? std::min(model_.dt * static_cast<double>(k - *back_ + 1) / kReturn, 1.0) : 1.0;
}

ContactPredictor::Answer ContactPredictor::solve(std::uint64_t k, const Vector3& tip) noexcept {
  Answer answer;
  past(k) = {.step = k};
  last_step_ = k;
  const Vector3 tip_before = std::exchange(last_tip_, tip).value_or(tip);
  silent_ = silent_ || !reaches(k);
  if (!reaches(k)) {  // what the device still shows acts where it did
    hold(k);
    return answer;
  }
  answer.known = true;
  const double share_of_it = share(k);
  if (!model_.valid) return answer;
  move_to(k - 1);
  const FreeMotion free = free_motion(*body_, model_.free_forces, motion_);
  const Quaternion& Q = free.halfway;
  const RigidState end = end_of_step(*body_, model_.free_forces, free, Q * model_.other_force,
                                     Q * model_.other_torque);
  const Vector3 tip_B = end.orientation.conjugate() * (tip - end.position);
  const bool held = model_.state == ContactState::kHeld;
  const Vector3 surface = surface_at(k);
  const double way = (tip - tip_before - model_.dt * motion_.velocity).norm();
  if (!held && !touch(k, tip_B - surface, way)) return answer;
  const Vector3 arm = surface + offset_;
  ContactConstraint posed;
  contact_.pose(model_.normal, model_.friction, arm, tip_B, posed);
  const Matrix3 W = model_.response[0] + body_->mobility().between(arm, arm) + model_.series;
  const SingleContact found =
      solve_single_contact(W / share_of_it, posed.gap, posed.law, posed.normal, posed.friction);
  if (!found.force.allFinite()) return {};
  if (found.mode == ContactMode::kOpen) {
    end_contact();
    return answer;
  }
  contact_.set_slipping(found.mode == ContactMode::kSlipping);
  offset_ += found.slip;
  last_place_ = model_.place + offset_;
  const Vector3 force = bounded_force(found.force);
  answer.force = Q * force;
  answer.state = held ? ContactState::kHeld : ContactState::kTouching;
  answer.normal = end.orientation * model_.normal;
  const Vector3 free_displacement = surface - model_.place;
  const Vector3 moved = free_displacement + model_.response[0] * force;
  const Vector3 shift = displacement_.arm_shift(k, free_displacement, moved);
  displacement_.remember(k, moved);
  past(k) = {k, answer.force, force, arm + shift, found.slip, Q, answer.state};
  return answer;
}

void ContactPredictor::hold(std::uint64_t k) noexcept {
  Past held = k > 0 && past(k - 1).step == k - 1 ? past(k - 1) : Past{};
  held.step = k;
  held.slip.setZero();
  past(k) = held;
  last_step_ = k;
}

void ContactPredictor::show(std::uint64_t step, const Vector3& force) noexcept {
  Past& shown = past(step);
  if (shown.step != step) return;
  const Vector3 force_B = shown.halfway.conjugate() * bounded_force(force);
  switch (shown.contact) {
    case ContactState::kFree:
      return;
    case ContactState::kHeld:
      shown.force_B = force_B;
      break;
    case ContactState::kTouching:
      shown.force_B = within_cone(force_B, model_.normal, model_.friction.static_);
      break;
  }
  shown.force = shown.halfway * shown.force_B;
}

Vector3 ContactPredictor::arm(std::uint64_t step) const noexcept {
  return past(step).step == step ? past(step).arm : Vector3::Zero();
}

Vector3 ContactPredictor::applied(std::uint64_t step) const noexcept {
  return past(step).step == step ? past(step).force : Vector3::Zero();
}

}  // namespace irdm
