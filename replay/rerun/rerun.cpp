#include "replay/rerun/rerun.hpp"

#include <algorithm>
#include <memory>

#include "common/error.hpp"
#include "common/realtime/no_denormals.hpp"
#include "replay/rerun/forced_object.hpp"

namespace irdm::replay {
namespace {

StylusCommand command_of(const StylusRecord& stylus, bool solve_bridged) {
  StylusCommand command{stylus.present, stylus.buttons, stylus.tip, std::nullopt};
  command.orientation = stylus.orientation;
  if (!solve_bridged) command.bridged = stylus.bridged;
  return command;
}

}  // namespace

InputRerun::InputRerun(const SimulationConfig& config, bool solve_bridged)
    : config_(config), solve_bridged_(solve_bridged), simulation_(config) {}

void InputRerun::insert_delayed_force(const StepRecord& recorded) {
  for (const LateForce& late : recorded.late.view()) {
    if (simulation_.insert_delayed_force(late)) continue;
    throw Error("/late", "has a force for a step that is not in the trace", "record it again");
  }
}

// In the order in which the force thread does it.
void InputRerun::step(const StepRecord& recorded, StepRecord& again) {
  if (!solve_bridged_) insert_delayed_force(recorded);
  if (!(recorded.settings == simulation_.settings())) {
    check_settings(config_, recorded.settings);
    simulation_.set(recorded.settings);
  }
  std::array<StylusCommand, kMaxStyluses> commands;
  const auto styluses = static_cast<std::size_t>(recorded.stylus_count);
  for (std::size_t s = 0; s < styluses; ++s) {
    commands[s] = command_of(recorded.stylus[s], solve_bridged_);
  }
  simulation_.step({commands.data(), styluses}, again, recorded.reset);
}

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
  const RecordedStep whole{
      {recorded.stylus.data(), static_cast<std::size_t>(recorded.stylus_count)},
      recorded.body_contacts()};
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    ObjectRecord& object = again.object[i];
    object.asleep ? objects_[i]->rest(object) : objects_[i]->step(object, whole);
  }
  write_floor_and_styluses(again);
}

// In W, as the objects stand half-way through the step.
void ForceRerun::write_floor_and_styluses(StepRecord& again) const {
  const auto styluses = static_cast<std::size_t>(again.stylus_count);
  for (std::size_t s = 0; s < styluses; ++s) {
    if (again.stylus[s].tool < 0) again.stylus[s].force.setZero();
  }
  for (const BodyContactRecord& contact : again.body_contacts()) {
    const int s = stylus_of_ball(config_, contact.other);
    if (s >= 0) again.stylus[static_cast<std::size_t>(s)].force -= contact.force;
  }
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

std::vector<DelayedForces> delayed_forces(const Recording& recording) {
  std::vector<DelayedForces> told;
  std::size_t begin = 0;  // of what has happened since the last reset
  const auto record = std::make_unique<StepRecord>();
  const auto own = std::make_unique<StepRecord>();
  for (std::size_t k = 0; k < recording.steps(); ++k) {
    recording.step(k, *record);
    if (record->reset) begin = k;
    for (const LateForce& late : record->late.view()) {
      const auto ago = static_cast<std::size_t>(late.age) + 1;
      if (k < begin + ago) continue;
      recording.step(k - ago, *own);
      const ObjectRecord& object = own->object[static_cast<std::size_t>(late.object)];
      told.push_back({k - ago, late, object.halfway});
    }
  }
  std::stable_sort(told.begin(), told.end(),
                   [](const DelayedForces& a, const DelayedForces& b) { return a.step < b.step; });
  return told;
}

void add_delayed_forces(const std::vector<DelayedForces>& told, std::size_t step, bool held_anew,
                        StepRecord& record) {
  auto one = std::lower_bound(told.begin(), told.end(), step,
                              [](const DelayedForces& a, std::size_t k) { return a.step < k; });
  for (; one != told.end() && one->step == step; ++one) {
    const auto s = static_cast<std::size_t>(one->late.stylus);
    const auto i = static_cast<std::size_t>(one->late.object);
    StylusRecord& stylus = record.stylus[s];
    const bool held = record.object[i].contact[s].state == ContactState::kHeld && stylus.present &&
                      (stylus.buttons & kGrabButton) != 0;
    if (held_anew && held) continue;
    stylus.force -= one->orientation * one->late.force;
  }
}

}  // namespace irdm::replay
