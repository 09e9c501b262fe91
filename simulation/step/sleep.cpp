#include "simulation/step/sleep.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include "simulation/state/state_archive.hpp"

namespace irdm {
namespace {

// How far beyond its size at rest an object may reach, as it is deformed, as a share of that ...
constexpr double kDeformed = 0.5;
// ... and how far from it a stylus wakes it [m].
constexpr double kNearStylus = 5e-3;

// The surface nodes farthest along the directions to the corners of a tetrahedron.
std::array<int, 4> far_apart(const RestSurface& rest) noexcept {
  const std::array<Vector3, 4> ways{Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1),
                                    Vector3(-1, -1, 1)};
  std::array<int, 4> nodes{};
  for (std::size_t p = 0; p < ways.size(); ++p) {
    for (int i = 1; i < rest.node_count(); ++i) {
      if (ways[p].dot(rest.node(i)) > ways[p].dot(rest.node(nodes[p]))) nodes[p] = i;
    }
  }
  return nodes;
}

}  // namespace

Sleep::Sleep(const SimulationConfig& config,
             const std::vector<std::unique_ptr<SoftObject>>& objects, WorldContacts* world)
    : world_(world),
      dt_(objects.front()->model().dt),
      steps_(static_cast<int>(std::ceil(config.sleep_time / dt_))),
      bodies_(objects.size()),
      leader_(objects.size(), 0) {
  for (std::size_t i = 0; i < objects.size(); ++i) {
    bodies_[i].object = objects[i].get();
    bodies_[i].radius = objects[i]->surface().bounding_radius();
    bodies_[i].probes = far_apart(objects[i]->surface());
  }
  for (const SimulationStylus& stylus : config.styluses) {
    reaches_.push_back(stylus.reach + kNearStylus);
    if (stylus.tool) body(stylus.tool->object).led = true;
  }
}

void Sleep::wake(int object) noexcept {
  if (!asleep(object)) return;
  const int group = body(object).group;
  for (Body& body : bodies_) {
    if (!body.object->asleep() || body.group != group) continue;
    body.object->wake();
    body.rested = 0;
    --asleep_;
  }
  if (world_ != nullptr) world_->release_awake();
}

void Sleep::wake_all() noexcept {
  for (int i = 0; i < static_cast<int>(bodies_.size()); ++i) {
    wake(i);
    body(i).rested = 0;
  }
}

void Sleep::archive(StateArchive& state) {
  for (Body& body : bodies_) {
    state.value(body.places);
    state.value(body.rested);
    state.value(body.group);
    if (body.object->asleep()) state.value(body.held);
  }
  state.value(tips_);
  state.value(asleep_);
}

// Whether a stylus may touch object i in this step, or exerts a force on it.
bool Sleep::reached(int i, std::span<const StylusCommand> commands) const noexcept {
  const Body& body = bodies_[static_cast<std::size_t>(i)];
  for (std::size_t s = 0; s < commands.size(); ++s) {
    const StylusCommand& command = commands[s];
    if (command.given && command.given->object == i) return true;
    const bool bridged = command.bridged && command.bridged->object == i;
    if (bridged && !command.bridged->force.isZero(0.0)) return true;
    if (!command.present || !command.tip.allFinite()) continue;
    const double way = (command.tip - tips_[s].value_or(command.tip)).norm();
    const double reach = (1.0 + kDeformed) * body.radius + reaches_[s] + way;
    if ((command.tip - body.object->state().position).norm() <= reach) return true;
  }
  return false;
}

void Sleep::begin(std::span<const StylusCommand> commands, StepRecord& record) noexcept {
  const int count = static_cast<int>(bodies_.size());
  for (int i = 0; i < count; ++i) {
    if (!reached(i, commands)) continue;
    wake(i);
    body(i).rested = 0;
  }
  for (std::size_t s = 0; s < commands.size(); ++s) {
    tips_[s].reset();
    if (commands[s].present && commands[s].tip.allFinite()) tips_[s] = commands[s].tip;
  }
  begin_awake(commands, record);
  if (asleep_ == 0) return;
  if (wake_neighbours()) begin_awake(commands, record);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].object->asleep()) continue;
    bodies_[i].object->rest(commands, bodies_[i].held);
    copy_object(bodies_[i].held, commands.size(), record.object[i]);
  }
}

// Of what has not begun it yet.
void Sleep::begin_awake(std::span<const StylusCommand> commands, StepRecord& record) noexcept {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    if (body.object->asleep() || std::exchange(body.begun, true)) continue;
    body.object->begin(commands, record.object[i]);
  }
}

// What something awake comes near to, and what is near to that. False: nothing.
bool Sleep::wake_neighbours() noexcept {
  if (world_ == nullptr) return false;
  bool any = false;
  for (bool woken = true; woken;) {
    woken = false;
    for (const auto& pair : world_->pairs()) {
      const bool first = asleep(pair->object());
      const bool wakes =
          pair->other() < 0 ? first && pair->driven() : first != asleep(pair->other());
      if (!wakes || !pair->near()) continue;
      wake(first ? pair->object() : pair->other());
      woken = any = true;
    }
  }
  return any;
}

bool Sleep::still(const Body& body) const noexcept {
  const SoftObject& object = *body.object;
  if (body.led || object.touched_by_stylus()) return false;
  const RigidState& state = object.state();
  const double turning = body.radius * object.rigid().angular_velocity(state).norm();
  return state.velocity.norm() + turning <= kStill;
}

// Counts the steps for which it has been at rest. Its elastic part is looked at only where its
// rigid motion is still.
void Sleep::follow(Body& body) noexcept {
  const SoftObject& object = *body.object;
  if (!still(body)) {
    body.rested = 0;
    return;
  }
  const RigidState& state = object.state();
  double moved = 0.0;
  std::array<Vector3, kProbes> now;
  for (std::size_t p = 0; p < kProbes; ++p) {
    const int node = body.probes[p];
    const Vector3 u = object.engine().free_displacement(node);
    now[p] = state.position + state.orientation * (object.surface().node(node) + u);
    moved = std::max(moved, (now[p] - body.places[p]).norm());
  }
  if (body.rested > 0 && moved <= kMoved) {
    ++body.rested;
    return;
  }
  body.rested = 1;
  body.places = now;
}

// What may touch scenery that moves does not rest.
void Sleep::find_groups() noexcept {
  std::iota(leader_.begin(), leader_.end(), 0);
  if (world_ == nullptr) return;
  for (const auto& pair : world_->pairs()) {
    if (pair->driven() && pair->near()) body(pair->object()).rested = 0;
    if (pair->other() < 0 || !pair->near()) continue;
    const int a = leader_[static_cast<std::size_t>(pair->object())];
    const int b = leader_[static_cast<std::size_t>(pair->other())];
    std::replace(leader_.begin(), leader_.end(), std::max(a, b), std::min(a, b));
  }
}

// Whether the forces on it cancel, as they are in the records of its steps asleep.
bool Sleep::balanced(const ObjectRecord& record) const noexcept {
  return (record.velocity - record.start.velocity).norm() <= kUnbalanced * dt_;
}

void Sleep::end(const StepRecord& record) noexcept {
  bool ready = false;
  for (Body& body : bodies_) {
    body.begun = false;
    if (body.object->asleep()) continue;
    follow(body);
    ready = ready || body.rested >= steps_;
  }
  if (!ready) return;
  find_groups();
  std::array<bool, kMaxObjects> rests;
  rests.fill(true);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const bool at_rest =
        bodies_[i].object->asleep() || (bodies_[i].rested >= steps_ && balanced(record.object[i]));
    bool& all = rests[static_cast<std::size_t>(leader_[i])];
    all = all && at_rest;
  }
  bool any = false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!rests[static_cast<std::size_t>(leader_[i])]) continue;
    bodies_[i].group = leader_[i];
    if (bodies_[i].object->asleep()) continue;
    bodies_[i].held = record.object[i];
    bodies_[i].object->fall_asleep(bodies_[i].held);
    ++asleep_;
    any = true;
  }
  if (any && world_ != nullptr) world_->hold(record);
}

}  // namespace irdm
