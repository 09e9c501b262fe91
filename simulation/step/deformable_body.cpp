#include "simulation/step/deformable_body.hpp"

#include "simulation/state/state_archive.hpp"
#include "simulation/step/settings.hpp"

namespace irdm {

DeformableBody::DeformableBody(const SimulationObject& object, const Vector3& gravity)
    : object_(object),
      rigid_(model().body, model().dt),
      engine_(make_engine(object.model)),
      capabilities_(engine_->capabilities()),
      inertial_loading_(has_inertial_loading(model(), object.inertial_loading)) {
  start_.position = object.position;
  start_.orientation = object.orientation.normalized();
  start_.velocity = object.velocity;
  start_.angular_momentum = rigid_.angular_momentum(start_.orientation, object.angular_velocity);
  state_ = start_;
  free_forces_ = {gravity, object.damping, object.tether, start_.position, start_.orientation};
  follow_gravity(*engine_, object_, gravity);
}

void DeformableBody::reset() noexcept {
  state_ = start_;
  past_.clear();
  end_ = {};
  engine_->reset();
}

void DeformableBody::set(const Vector3& gravity, const ObjectSettings& settings) noexcept {
  free_forces_.gravity = gravity;
  free_forces_.damping = settings.damping;
  free_forces_.tether = settings.tether;
  inertial_loading_ = has_inertial_loading(model(), settings.inertial_loading);
  follow_settings(*engine_, settings, material_damping_);
  follow_gravity(*engine_, object_, gravity);
}

// The spin is that without the torques of the step itself: contacts are solved on a surface that
// their own forces do not yet blow up.
void DeformableBody::begin_step(ObjectRecord& record) noexcept {
  state_ = past_.replay(rigid_, free_forces_, state_);
  record.start = state_;
  record.spin = inertial_loading_ ? rigid_.mid_step_spin(state_) : Vector3::Zero();
  InertialLoading* const loading = capabilities_.inertial_loading;
  if (inertial_loading_ && loading != nullptr) loading->set_angular_velocity(record.spin);
  motion_ = next_motion();
  record.halfway = motion_.halfway;
}

void DeformableBody::end_step(std::span<const NodalForce> nodal,
                              const RigidStateHistory::Forces& forces,
                              ObjectRecord& record) noexcept {
  engine_->advance(nodal);
  past_.remember(state_, motion_.halfway, forces, led_);
  end_ =
      end_of_step(rigid_, free_forces_, motion_, forces.sum, forces.torque(motion_.halfway), led_);
  state_ = end_.state;
  record.position = state_.position;
  record.orientation = state_.orientation;
  record.velocity = state_.velocity;
  record.angular_velocity = rigid_.angular_velocity(state_);
}

void DeformableBody::rest(ObjectRecord& record) noexcept {
  state_.velocity.setZero();
  state_.angular_momentum.setZero();
  motion_ = next_motion();
  record.start = state_;
  record.halfway = record.orientation = state_.orientation;
  record.position = state_.position;
  record.velocity = record.angular_velocity = record.spin = Vector3::Zero();
}

void DeformableBody::archive(StateArchive& state) {
  state.value(inertial_loading_);
  state.value(free_forces_);
  state.value(state_);
  state.value(motion_);
  state.value(end_);
  const double before = material_damping_;
  state.value(material_damping_);
  if (material_damping_ != before && capabilities_.damping != nullptr) {
    capabilities_.damping->scale_damping(material_damping_);
  }
  engine_->archive(state);
  if (!state.reading()) return;
  past_.clear();
  led_ = {};
}

Vector3 DeformableBody::coupling_torque() const noexcept {
  if (!led_.any()) return Vector3::Zero();
  const Vector3 arm = state_.orientation * led_.coupling->reference();
  return end_.coupling.torque + arm.cross(end_.coupling.force);
}

void DeformableBody::insert_delayed_force(std::span<const NodalForce> nodal, const Vector3& force,
                                          const Vector3& arm, int age) noexcept {
  engine_->add_delayed_force(nodal, age);
  past_.add(age, past_.halfway(age) * force, arm);
}

}  // namespace irdm
