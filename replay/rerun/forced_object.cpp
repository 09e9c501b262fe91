#include "replay/rerun/forced_object.hpp"

#include "simulation/step/gravity_load.hpp"
#include "simulation/step/inertial_loading.hpp"

namespace irdm::replay {
namespace {

std::vector<double> radii_of(const SimulationConfig& config) {
  std::vector<double> radii;
  for (const SimulationStylus& stylus : config.styluses) radii.push_back(stylus.radius);
  return radii;
}

}  // namespace

ForcedObject::ForcedObject(const SimulationConfig& config, std::size_t number)
    : object_(config.objects[number]),
      model_(object_.model),
      body_(model_->body, model_->dt),
      engine_(make_engine(model_)),
      surface_(model_->mesh),
      forces_(surface_, radii_of(config)),
      feels_spin_(has_inertial_loading(*model_, object_.inertial_loading)) {
  for (const double radius : radii_of(config)) masks_.emplace_back(surface_, radius);
  start_.position = object_.position;
  start_.orientation = object_.orientation.normalized();
  start_.velocity = object_.velocity;
  start_.angular_momentum = body_.angular_momentum(start_.orientation, object_.angular_velocity);
  state_ = start_;
  free_forces_ = {config.gravity, object_.damping, object_.tether, start_.position,
                  start_.orientation};
  follow_gravity(*engine_, object_, config.gravity);
}

void ForcedObject::reset() {
  state_ = start_;
  past_.clear();
  engine_->reset();
}

void ForcedObject::insert_delayed_force(const LateForce& late) {
  if (late.age >= past_.count()) return;
  engine_->add_delayed_force(forces_.of(late), late.age);
  past_.add(late.age, past_.halfway(late.age) * late.force, late.arm);
}

void ForcedObject::set(const Vector3& gravity, const ObjectSettings& settings) {
  free_forces_.gravity = gravity;
  free_forces_.damping = settings.damping;
  free_forces_.tether = settings.tether;
  feels_spin_ = has_inertial_loading(*model_, settings.inertial_loading);
  follow_settings(*engine_, settings, material_damping_);
  follow_gravity(*engine_, object_, gravity);
}

// Of a patch at the end of the coming step, were there no force in it [m], B.
Vector3 ForcedObject::place(const ContactPatch& patch) const {
  return mean(patch, [&](int node) -> Vector3 {
    return surface_.node(node) + engine_->free_displacement(node);
  });
}

RigidStateHistory::Forces ForcedObject::collect(const ObjectRecord& recorded) {
  const Quaternion& Q = recorded.halfway;
  RigidStateHistory::Forces forces;
  for (std::size_t s = 0; s < masks_.size(); ++s) {
    const ContactRecord& contact = recorded.contact[s];
    if (contact.state == ContactState::kFree) continue;
    masks_[s].spread(contact.point, patch_);
    forces.add(Q * contact.force, place(patch_) + contact.offset + contact.arm_shift);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(recorded.floor_count); ++i) {
    const FloorForce& floor = recorded.floor[i];
    forces.add(Q * floor.force.cast<double>(),
               surface_.node(floor.node) + engine_->free_displacement(floor.node));
  }
  return forces;
}

void ForcedObject::step(ObjectRecord& again, std::span<const StylusRecord> /*styluses*/) {
  state_ = past_.replay(body_, free_forces_, state_);
  again.start = state_;
  again.spin = feels_spin_ ? body_.mid_step_spin(state_) : Vector3::Zero();
  if (feels_spin_) engine_->set_angular_velocity(again.spin);
  const FreeMotion motion = free_motion(body_, free_forces_, state_);
  again.halfway = motion.halfway;
  const RigidStateHistory::Forces forces = collect(again);
  engine_->advance(forces_.of(again));
  past_.remember(state_, again.halfway, forces);
  state_ = end_of_step(body_, free_forces_, motion, forces.sum, forces.torque(again.halfway));
  again.position = state_.position;
  again.orientation = state_.orientation;
  again.velocity = state_.velocity;
  again.angular_velocity = body_.angular_velocity(state_);
}

}  // namespace irdm::replay
