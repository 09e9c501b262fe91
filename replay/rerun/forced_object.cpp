#include "replay/rerun/forced_object.hpp"

#include <string>

#include "simulation/step/stylus_patch.hpp"

namespace irdm::replay {
namespace {

StylusCommand led_as(const StylusRecord& stylus) {
  StylusCommand command{stylus.present, stylus.buttons, stylus.tip, std::nullopt};
  command.orientation = stylus.orientation;
  return command;
}

}  // namespace

ForcedObject::ForcedObject(const SimulationConfig& config, std::size_t number)
    : number_(static_cast<int>(number)),
      body_(config.objects[number], config.gravity),
      surface_(body_.model().mesh),
      forces_(config, number, surface_) {
  for (const SimulationStylus& stylus : config.styluses) {
    masks_.emplace_back(surface_, patch_radius(stylus, surface_));
  }
  for (std::size_t s = 0; s < config.styluses.size(); ++s) {
    const std::optional<ToolCoupling>& tool = config.styluses[s].tool;
    if (!tool || tool->object != number_) continue;
    lead_.emplace(*tool, config.objects[number], "tool of stylus " + std::to_string(s + 1));
    led_by_ = s;
  }
}

void ForcedObject::reset() {
  body_.reset();
  if (lead_) lead_->reset();
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
  for (const TouchForce& touch : touch_) forces.add(touch.force, Q.conjugate() * touch.arm);
  return forces;
}

void ForcedObject::lead(std::span<const StylusRecord> styluses) {
  if (!lead_) return;
  lead_->begin(led_as(styluses[led_by_]));
  body_.lead(lead_->step());
}

void ForcedObject::step(ObjectRecord& again, const RecordedStep& recorded) {
  lead(recorded.styluses);
  find_touch_forces(number_, again, recorded.body_contacts, touch_);
  body_.begin_step(again);
  const RigidStateHistory::Forces forces = collect(again);
  body_.end_step(forces_.of(again, recorded.body_contacts), forces, again);
}

}  // namespace irdm::replay
