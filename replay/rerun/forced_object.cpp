#include "replay/rerun/forced_object.hpp"

namespace irdm::replay {
namespace {

std::vector<double> radii_of(const SimulationConfig& config) {
  std::vector<double> radii;
  for (const SimulationStylus& stylus : config.styluses) radii.push_back(stylus.radius);
  return radii;
}

}  // namespace

ForcedObject::ForcedObject(const SimulationConfig& config, std::size_t number)
    : body_(config.objects[number], config.gravity),
      surface_(body_.model().mesh),
      forces_(surface_, radii_of(config)) {
  for (const double radius : radii_of(config)) masks_.emplace_back(surface_, radius);
}

void ForcedObject::reset() {
  body_.reset();
}

void ForcedObject::insert_delayed_force(const LateForce& late) {
  if (late.age >= body_.past().count()) return;
  body_.insert_delayed_force(forces_.of(late), late.force, late.arm, late.age);
}

void ForcedObject::set(const Vector3& gravity, const ObjectSettings& settings) {
  body_.set(gravity, settings);
}

// Of a patch at the end of the coming step, were there no force in it [m], B.
Vector3 ForcedObject::place(const ContactPatch& patch) const {
  return mean(patch, [&](int node) -> Vector3 {
    return surface_.node(node) + body_.engine().free_displacement(node);
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
               surface_.node(floor.node) + body_.engine().free_displacement(floor.node));
  }
  return forces;
}

void ForcedObject::step(ObjectRecord& again, std::span<const StylusRecord> /*styluses*/) {
  body_.begin_step(again);
  const RigidStateHistory::Forces forces = collect(again);
  body_.end_step(forces_.of(again), forces, again);
}

}  // namespace irdm::replay
