#include "simulation/deformation/deformation.hpp"

#include <algorithm>

#include "simulation/step/settings.hpp"

namespace irdm {

SurfaceFrame rest_frame(const SimulationConfig& config) {
  SurfaceFrame frame;
  for (const SimulationObject& object : config.objects) {
    frame.objects.push_back({object.position, object.orientation,
                             Points::Zero(object.model->mesh.surface_node_count(), 3)});
  }
  frame.styluses.resize(config.styluses.size());
  frame.contacts.resize(config.styluses.size());
  return frame;
}

StylusContact contact_on(const ModelMesh& mesh, const ContactRecord& contact) {
  if (contact.state == ContactState::kFree) return {};
  return {interpolate(contact.point, [&](int node) -> Vector3 { return mesh.rest_position(node); }),
          contact.slipping};
}

Deformation::Deformation(const SimulationConfig& config, double tolerance) {
  for (const SimulationObject& object : config.objects) {
    Follower follower{object, make_engine(object.model), nullptr, nullptr,
                      has_inertial_loading(*object.model, object.inertial_loading)};
    follow_gravity(*follower.engine, object, config.gravity);
    follower.tolerance = tolerance * object.model->mesh.nodes.rowwise().norm().maxCoeff();
    follower.surface = std::make_unique<RestSurface>(object.model->mesh);
    follower.forces = std::make_unique<RecordedForces>(config, objects_.size(), *follower.surface);
    objects_.push_back(std::move(follower));
  }
}

void Deformation::advance(const StepRecord& record) {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (record.object[i].asleep) continue;
    InertialLoading* const loading = objects_[i].engine->capabilities().inertial_loading;
    if (objects_[i].has_inertial_loading && loading != nullptr) {
      loading->set_angular_velocity(record.object[i].spin);
    }
    objects_[i].engine->advance(objects_[i].forces->of(record.object[i], record.body_contacts()));
  }
}

void Deformation::follow_settings(const StepRecord& record) {
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const ObjectSettings& settings = record.settings.object[i];
    Follower& follower = objects_[i];
    follower.has_inertial_loading =
        has_inertial_loading(*follower.object.model, settings.inertial_loading);
    irdm::follow_settings(*follower.engine, settings, follower.material_damping);
    follow_gravity(*follower.engine, follower.object, record.settings.gravity);
  }
}

void Deformation::follow(const StepRecord& record) {
  std::uint64_t next = started_ ? last_.force_step + 1 : 0;
  lost_steps_ += record.force_step - next;
  if (record.reset_step >= next) {
    // What was before it does not count any more, and of lost steps after it nothing is known.
    for (Follower& follower : objects_) follower.engine->reset();
    const std::uint32_t settings_change = last_.settings_change;
    last_ = StepRecord{};
    last_.settings_change = settings_change;
    next = record.reset_step;
  }
  for (; next < record.force_step; ++next) advance(last_);
  for (const LateForce& late : record.late.view()) {  // of steps with the settings as they were
    Follower& follower = objects_[static_cast<std::size_t>(late.object)];
    follower.engine->add_delayed_force(follower.forces->of(late), late.age);
  }
  if (record.settings_change != last_.settings_change) follow_settings(record);
  advance(record);
  copy_step(record, last_);
  trail_.follow(record);
  started_ = true;
}

StylusContact Deformation::contact(std::size_t s) const {
  const int object = last_.stylus[s].object;
  if (object < 0) return {};
  const auto i = static_cast<std::size_t>(object);
  return contact_on(objects_[i].object.model->mesh, last_.object[i].contact[s]);
}

void Deformation::compute(SurfaceFrame& frame) const {
  frame.force_step = last_.force_step;
  frame.time = last_.time;
  std::vector<SurfaceRequest> requests;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    frame.objects[i].position = last_.object[i].position;
    frame.objects[i].orientation = last_.object[i].orientation;
    requests.push_back(
        {objects_[i].engine.get(), objects_[i].tolerance, &frame.objects[i].displacement});
  }
  displacements(requests);
  std::copy_n(last_.stylus.begin(), frame.styluses.size(), frame.styluses.begin());
  for (std::size_t s = 0; s < frame.contacts.size(); ++s) frame.contacts[s] = contact(s);
  frame.trail = trail_;
  const std::span<const BodyContactRecord> touching = last_.body_contacts();
  frame.body_contacts.assign(touching.begin(), touching.end());
}

}  // namespace irdm
