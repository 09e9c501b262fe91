#include "simulation/step/simulation.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "common/number_text.hpp"
#include "common/realtime/no_denormals.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {
Simulation::Simulation(const SimulationConfig& config)
    : settings_(initial_settings(config)), stylus_count_(config.styluses.size()) {
  if (config.objects.empty() || config.objects.size() > kMaxObjects) {
    throw Error("scene", "has " + std::to_string(config.objects.size()) + " objects",
                "use 1 to " + std::to_string(kMaxObjects));
  }
  if (config.styluses.empty() || config.styluses.size() > kMaxStyluses) {
    throw Error("scene", "has " + std::to_string(config.styluses.size()) + " styluses",
                "use 1 to " + std::to_string(kMaxStyluses));
  }
  reset_down_.fill(true);
  local_model_object_.fill(-1);
  for (std::size_t s = 0; s < stylus_count_; ++s) {
    max_force_[s] = config.styluses[s].max_force;
    if (!config.styluses[s].has_ball() || config.styluses[s].radius > 0.0) continue;
    throw Error("stylus " + std::to_string(s + 1), "has a ball of radius 0",
                "give it a radius, or shape \"patch\"");
  }
  dt_ = config.objects.front().model->dt;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    const SimulationObject& object = config.objects[i];
    if (object.model->dt != dt_) {
      throw Error("scene",
                  "has models of different dt: " + object_name(config, 0) + " " + number_text(dt_) +
                      " s, " + object_name(config, i) + " " + number_text(object.model->dt) + " s",
                  "compute them with the same response.dt");
    }
    objects_.push_back(std::make_unique<SoftObject>(object, config, static_cast<int>(i)));
  }
  check_settings(config, settings_);
  for (std::size_t s = 0; s < stylus_count_; ++s) {
    if (config.styluses[s].tool) add_tool(config, s);
  }
  if (touches_bodies(config)) {
    world_ = std::make_unique<WorldContacts>(config, objects_);
    if (!world_->any()) world_.reset();
  }
  if (config.sleep_time > 0) sleep_ = std::make_unique<Sleep>(config, objects_, world_.get());
}

void Simulation::add_tool(const SimulationConfig& config, std::size_t s) {
  const ToolCoupling& tool = *config.styluses[s].tool;
  const std::string where = "tool of stylus " + std::to_string(s + 1);
  if (tool.object < 0 || tool.object >= object_count()) {
    throw Error(where, "is object " + std::to_string(tool.object + 1) + ", which is not there",
                "use one of 1 to " + std::to_string(object_count()));
  }
  for (const auto& other : tools_) {
    if (!other || other->object() != tool.object) continue;
    throw Error(where, "is an object that another stylus leads", "give each stylus its own");
  }
  tools_[s] = std::make_unique<ToolLead>(
      tool, config.objects[static_cast<std::size_t>(tool.object)], where);
}

void Simulation::set(const Settings& settings) noexcept {
  const bool changed = !(settings == settings_);
  settings_ = settings;
  ++settings_change_;
  if (sleep_ && changed) sleep_->wake_all();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    objects_[i]->set(settings.gravity, settings.object[i]);
  }
}

std::uint64_t Simulation::cache_misses() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& object : objects_) sum += object->cache_misses();
  return sum;
}

std::uint64_t Simulation::limited() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& object : objects_) sum += object->limited();
  return sum;
}

void Simulation::reset() noexcept {
  if (sleep_) sleep_->wake_all();
  for (const auto& object : objects_) object->reset();
  if (world_) world_->reset();
  for (const auto& tool : tools_) {
    if (tool) tool->reset();
  }
  late_.count = 0;
  was_reset_ = true;
  reset_step_ = next_step_;
}

void Simulation::archive(StateArchive& state) {
  state.same(objects_.size());
  state.same(stylus_count_);
  state.same(world_ ? 1 : 0);
  state.same(sleep_ ? 1 : 0);
  state.value(settings_);
  state.value(settings_change_);
  state.value(next_step_);
  state.value(reset_step_);
  state.value(was_reset_);
  state.value(reset_down_);
  state.value(late_);
  for (const auto& object : objects_) object->archive(state);
  if (world_) world_->archive(state);
  if (sleep_) sleep_->archive(state);
  for (const auto& tool : tools_) {
    if (tool) tool->archive(state);
  }
  if (state.reading()) local_model_object_.fill(-1);
}

// A button that is down when its stylus appears has not gone down.
bool Simulation::reset_pressed(std::span<const StylusCommand> commands) noexcept {
  bool pressed = false;
  for (std::size_t s = 0; s < stylus_count_; ++s) {
    const bool down = !commands[s].present || (commands[s].buttons & kResetButton) != 0;
    pressed = pressed || (commands[s].present && down && !reset_down_[s]);
    reset_down_[s] = down;
  }
  return pressed;
}

void Simulation::step(std::span<const StylusCommand> commands, StepRecord& record,
                      bool reset_first) noexcept {
  const NoDenormals here;  // in whatever thread: the same bits
  if (reset_pressed(commands) || reset_first) reset();
  record.reset = std::exchange(was_reset_, false);
  record.reset_step = reset_step_;
  record.force_step = next_step_++;
  record.time = static_cast<double>(next_step_) * dt_;
  record.settings = settings_;
  record.settings_change = settings_change_;
  record.late.count = std::exchange(late_.count, 0);
  std::copy_n(late_.force.begin(), record.late.count, record.late.force.begin());
  record.object_count = object_count();
  record.stylus_count = static_cast<int>(stylus_count_);
  if (record.reset) {
    std::copy_n(commands.begin(), stylus_count_, commands_.begin());
    for (StylusCommand& command : commands_) {
      if (command.bridged) command.bridged = BridgedForce{};  // for the object as it was before
    }
    commands = commands_;
  }
  record.body_contact.clear();
  const std::span<const StylusCommand> all = std::exchange(commands, own_contacts(commands));
  if (world_) world_->begin_step(all);
  begin_objects(commands, record);
  if (world_) {
    world_->solve(record);
  } else {
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (objects_[i]->asleep()) continue;
      objects_[i]->solve(record.object[i]);
      objects_[i]->write(record.object[i]);
    }
  }
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (!objects_[i]->asleep()) objects_[i]->finish(commands, record.object[i]);
  }
  if (sleep_) sleep_->end(record);
  for (std::size_t s = 0; s < stylus_count_; ++s) {
    write_stylus(s, all[s], record);
  }
}

void Simulation::begin_objects(std::span<const StylusCommand> commands,
                               StepRecord& record) noexcept {
  if (sleep_) {
    sleep_->begin(commands, record);
    return;
  }
  for (std::size_t i = 0; i < objects_.size(); ++i) objects_[i]->begin(commands, record.object[i]);
}

// Moves the tools, and returns the commands for the contacts that objects solve themselves: there
// a stylus that leads a tool or has a ball is absent.
std::span<const StylusCommand> Simulation::own_contacts(
    std::span<const StylusCommand> commands) noexcept {
  std::span<const StylusCommand> contacts = commands;
  for (std::size_t s = 0; s < stylus_count_; ++s) {
    if (!tools_[s] && ball(s) == nullptr) continue;
    if (contacts.data() == commands.data()) {
      std::copy_n(commands.begin(), stylus_count_, contacts_.begin());
      contacts = {contacts_.data(), stylus_count_};
    }
    contacts_[s] = {};
    if (!tools_[s]) {
      grip(s, commands[s]);
      continue;
    }
    tools_[s]->begin(commands[s]);
    objects_[static_cast<std::size_t>(tools_[s]->object())]->lead(tools_[s]->step());
  }
  return contacts;
}

// Writes the command of a stylus with a ball that holds an object, lets it go, or takes hold of it.
void Simulation::grip(std::size_t s, const StylusCommand& command) noexcept {
  if (!command.present) return;
  for (const auto& object : objects_) {
    if (object->contact_state(s) == ContactState::kFree) continue;
    contacts_[s] = command;
    return;
  }
  if ((command.buttons & kGrabButton) == 0) return;
  const std::optional<BallGrip> grip = world_->grip(s);
  if (!grip) return;
  contacts_[s] = command;
  contacts_[s].grip = grip;
}

// The object that a stylus is in contact with, or else the nearest.
int Simulation::touched_by(std::size_t s, const Vector3& tip) noexcept {
  int nearest = -1;
  double distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < object_count(); ++i) {
    SoftObject& candidate = *objects_[static_cast<std::size_t>(i)];
    if (candidate.contact_state(s) != ContactState::kFree || objects_.size() == 1) return i;
    const double here = candidate.distance(tip);
    if (here < distance) nearest = i;
    distance = std::min(distance, here);
  }
  return nearest;
}

bool Simulation::predict_horizon(std::size_t s, const Vector3& tip, int horizon,
                                 ContactModel& model, int& budget) noexcept {
  const NoDenormals here;
  model.valid = false;
  model.step = next_step_ - 1;
  model.dt = dt_;
  local_model_object_[s] = -1;
  if (next_step_ == 0 || !tip.allFinite() || tools_[s] || ball(s) != nullptr) return true;
  local_model_object_[s] = touched_by(s, tip);
  if (local_model_object_[s] < 0) return true;
  SoftObject& touched = *objects_[static_cast<std::size_t>(local_model_object_[s])];
  return touched.predict_horizon(s, tip, horizon, model, budget);
}

bool Simulation::insert_delayed_force(std::size_t s, const AppliedForce& applied,
                                      int age) noexcept {
  const NoDenormals here;
  if (age < 0 || age >= kMaxHorizon) return false;
  if (!applied.force.allFinite() || !applied.tip.allFinite() || !applied.arm.allFinite()) {
    return false;
  }
  if (late_.count == LateForces::kMost) return false;
  LateForce& entry = late_.force[late_.count];
  entry.stylus = static_cast<int>(s);
  entry.age = age;
  entry.object = local_model_object_[s];
  if (entry.object < 0) return false;
  SoftObject& touched = *objects_[static_cast<std::size_t>(entry.object)];
  if (!touched.insert_delayed_force(s, applied, entry)) return false;
  if (sleep_) sleep_->wake(entry.object);
  ++late_.count;
  return true;
}

bool Simulation::insert_delayed_force(const LateForce& late) noexcept {
  const NoDenormals here;
  if (late_.count == LateForces::kMost) return false;
  if (!objects_[static_cast<std::size_t>(late.object)]->insert_delayed_force(late)) return false;
  if (sleep_) sleep_->wake(late.object);
  late_.force[late_.count++] = late;
  return true;
}

void Simulation::tell_late(std::size_t s, const Vector3& tip, int age) noexcept {
  for (const auto& object : objects_) object->tell_late(s, tip, age);
}

// Step 6: -Q f, Q half-way through the step.
void Simulation::write_stylus(std::size_t s, const StylusCommand& command,
                              StepRecord& record) const noexcept {
  StylusRecord& stylus = record.stylus[s];
  stylus = StylusRecord{};
  stylus.present = command.present;
  stylus.buttons = command.buttons;
  stylus.tip = stylus.proxy = command.tip;
  stylus.bridged = command.bridged;
  if (stylus.bridged && stylus.bridged->object >= 0) {
    stylus.bridged->share = object(stylus.bridged->object).bridged_share(s);
  }
  if (tools_[s]) {
    stylus.orientation = command.orientation;
    write_tool(*tools_[s], stylus);
    return;
  }
  const StylusBall* const ball = this->ball(s);
  double largest = -1.0;
  if (ball != nullptr && ball->strongest().object >= 0) {
    stylus.force = -ball->force();
    stylus.object = ball->strongest().object;
    stylus.contact = ContactState::kTouching;
    largest = ball->strongest().force.norm();
  }
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const ContactRecord& contact = record.object[i].contact[s];
    if (contact.state == ContactState::kFree) continue;
    stylus.force -= record.object[i].halfway * contact.force;
    if (contact.force.norm() <= largest) continue;
    largest = contact.force.norm();
    stylus.object = static_cast<int>(i);
    stylus.contact = contact.state;
    stylus.proxy = contact.proxy;
  }
  if (ball != nullptr) stylus.proxy = command.tip + ball->compliance() * stylus.force;
}

void Simulation::write_tool(const ToolLead& lead, StylusRecord& stylus) const noexcept {
  const SoftObject& object = this->object(lead.object());
  stylus.tool = lead.object();
  stylus.proxy = object.state().position + object.state().orientation * lead.coupling().reference();
  stylus.force = -lead.share() * object.coupling().force;
  stylus.torque = -lead.share() * object.coupling().torque;
}

}  // namespace irdm
