#include "replay/rerun/force_rerun.hpp"

#include "common/realtime/no_denormals.hpp"
#include "replay/rerun/forced_object.hpp"

namespace irdm::replay {

namespace {

std::vector<std::unique_ptr<ForcedBody>> by_response(const SimulationConfig& config) {
  std::vector<std::unique_ptr<ForcedBody>> objects;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    objects.push_back(std::make_unique<ForcedObject>(config, i));
  }
  return objects;
}

}  // namespace

ForceRerun::ForceRerun(const SimulationConfig& config) : ForceRerun(config, by_response(config)) {}

ForceRerun::ForceRerun(const SimulationConfig& config,
                       std::vector<std::unique_ptr<ForcedBody>> objects)
    : config_(config), objects_(std::move(objects)), settings_(initial_settings(config)) {
  check_settings(config_, settings_);
}

void ForceRerun::step(const StepRecord& recorded, StepRecord& again) {
  const NoDenormals here;
  again = recorded;
  if (recorded.reset) {
    for (const auto& object : objects_) object->reset();
  }
  for (const LateForce& late : recorded.late.view()) {
    objects_[static_cast<std::size_t>(late.object)]->insert_delayed_force(late);
  }
  if (!(recorded.settings == settings_)) {
    check_settings(config_, recorded.settings);
    settings_ = recorded.settings;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      objects_[i]->set(settings_.gravity, settings_.object[i]);
    }
  }
  const std::span styluses(recorded.stylus.data(), static_cast<std::size_t>(recorded.stylus_count));
  for (std::size_t i = 0; i < objects_.size(); ++i) objects_[i]->step(again.object[i], styluses);
  write_floor_and_styluses(again);
}

// In W, as the objects stand half-way through the step.
void ForceRerun::write_floor_and_styluses(StepRecord& again) const {
  const auto styluses = static_cast<std::size_t>(again.stylus_count);
  for (std::size_t s = 0; s < styluses; ++s) again.stylus[s].force.setZero();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    ObjectRecord& object = again.object[i];
    const Quaternion& Q = object.halfway;
    for (std::size_t s = 0; s < styluses; ++s) {
      const ContactRecord& contact = object.contact[s];
      if (contact.state != ContactState::kFree) again.stylus[s].force -= Q * contact.force;
    }
    object.floor_force.setZero();
    for (std::size_t c = 0; c < static_cast<std::size_t>(object.floor_count); ++c) {
      object.floor_force += Q * object.floor[c].force.cast<double>();
    }
  }
}

}  // namespace irdm::replay
