#include <algorithm>
#include <cmath>

#include "simulation/step/soft_object.hpp"

// What the coming steps bring to one contact, and what comes late: the server's side of a contact
// that is solved at a bridge.

namespace irdm {

// What acts on the object besides one stylus: into nodal_, and its sums into the model.
void SoftObject::collect_others(std::size_t s, ContactModel& model) noexcept {
  nodal_.clear();
  model.other_force.setZero();
  model.other_torque.setZero();
  for (int i = 0; i < problem_.count(); ++i) {
    const ContactConstraint& solved = problem_.contact(i);
    if (solved.mode == ContactMode::kOpen) continue;
    Vector3 force = solved.force;
    if (i < floor_count_) {
      nodal_.add(floor_->node(i), force);
    } else {
      const auto a = static_cast<std::size_t>(i - floor_count_);
      if (contacts_[a].stylus == static_cast<int>(s)) continue;
      force = last_[static_cast<std::size_t>(contacts_[a].stylus)].average;
      nodal_.add(patches_[a], force);
    }
    model.other_force += force;
    model.other_torque += solved.arm.cross(force);
  }
}

void SoftObject::predict_horizon(std::size_t s, const Vector3& tip, int horizon,
                                 ContactModel& model) noexcept {
  const GodObject& stylus = styluses_[s];
  model.state = stylus.state();
  model.valid = model.state != ContactState::kFree || stylus.outside();
  if (!model.valid) return;
  model.horizon = std::clamp(horizon, 1, kMaxHorizon);
  model.slipping = stylus.slipping();
  model.friction = object_.friction;
  model.body = model_->body;
  model.motion = state_;
  model.free_forces = free_forces_;

  surface_.begin_step(*engine_);
  SurfacePoint point = stylus.point();
  if (model.state == ContactState::kFree) {
    point = surface_.closest(free_motion(body_, free_forces_, state_).to_body(tip)).point;
  }
  masks_[s].spread(point, local_model_patch_);
  if (model.state == ContactState::kHeld) {
    model.place = stylus.offset() + mean(local_model_patch_, [&](int i) { return rest_.node(i); });
  } else {
    const SmoothedSurface::Place place = rounded_[s].at(point);
    model.normal = place.normal;
    model.place = place.position;
  }

  collect_others(s, model);
  const auto count = static_cast<std::size_t>(model.horizon);
  engine_->predict_horizon(local_model_patch_, nodal_.view(), {model.path.data(), count},
                           {model.response.data(), count});

  model.series.setZero();
  const double stiffness = config_.styluses[s].coupling_stiffness;
  if (stiffness > 0) model.series.diagonal().array() += 1.0 / stiffness;
  if (!stylus.releasing()) return;
  const double left = 1.0 - (stylus.steps_since_release() + 1) * model_->dt / config_.release_time;
  model.valid = left > 0;
  if (!model.valid) return;
  const Vector3 arm = model.place + model.path[0];
  const Matrix3 within = model.response[0] + body_.mobility().between(arm, arm) + model.series;
  model.series += (1.0 / left - 1.0) * within;
}

bool SoftObject::place_late(std::size_t s, const Vector3& tip, LateForce& entry) noexcept {
  const LastContact& last = last_[s];
  const auto age = static_cast<std::uint64_t>(entry.age);
  const std::uint64_t step = steps_ - 1 - age;
  if (entry.age >= past_.count()) return false;
  if (last.any && last.first_step <= step && step <= last.last_step) {
    entry.point = last.point;
    entry.arm = last.arm;
    local_model_patch_ = last.patch;
    return true;
  }
  constexpr double kNear = 0.005;  // the tip may have gone on since [m]
  surface_.begin_step(*engine_);
  const SurfaceHit hit = surface_.closest(free_motion(body_, free_forces_, state_).to_body(tip));
  if (std::abs(hit.signed_distance) > kNear) return false;
  entry.point = hit.point;
  masks_[s].spread(entry.point, local_model_patch_);
  entry.arm = mean(local_model_patch_, [&](int i) { return rest_.node(i); });
  return true;
}

bool SoftObject::insert_delayed_force(std::size_t s, const AppliedForce& applied,
                                      LateForce& entry) noexcept {
  if (!place_late(s, applied.tip, entry)) return false;
  entry.force = past_.halfway(entry.age).conjugate() * applied.force;
  entry.arm = accepted_arm(applied.arm, entry.arm);
  return insert_delayed_force(entry);
}

// What acts is the entry: a run that is made again has nothing else.
bool SoftObject::insert_delayed_force(const LateForce& entry) noexcept {
  if (entry.age >= past_.count()) return false;
  masks_[static_cast<std::size_t>(entry.stylus)].spread(entry.point, local_model_patch_);
  nodal_.clear();
  nodal_.add(local_model_patch_, entry.force);
  engine_->add_delayed_force(nodal_.view(), entry.age);
  past_.add(entry.age, past_.halfway(entry.age) * entry.force, entry.arm);
  return true;
}

double SoftObject::distance(const Vector3& tip) noexcept {
  surface_.begin_step(*engine_);
  return surface_.closest(free_motion(body_, free_forces_, state_).to_body(tip)).signed_distance;
}

}  // namespace irdm
