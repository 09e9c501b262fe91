#include "simulation/step/world_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <utility>
#include <variant>

#include "common/error.hpp"
#include "common/number_text.hpp"
#include "simulation/state/state_archive.hpp"
#include "simulation/step/ball_contacts.hpp"
#include "simulation/step/object_sampling.hpp"

namespace irdm {
namespace {

// Bodies may be inside one another by so much at the start [m]: what rounding and a rest position
// that was computed by hand make.
constexpr double kDeepestOverlap = 5e-4;
// Objects with a floor that may be one contact problem: its matrix has room for all that their
// floors can add, 9 (200 m)^2 numbers for m of them.
constexpr std::size_t kMostOnFloor = 4;
// A pair alone can have all contacts of a step, of two each half of them. Of more pairs than these
// (two bodies, from both sides) each has fewer, so that there are some for all.
constexpr std::size_t kFewPairs = 2;
constexpr int kMostOfMany = 64;

// How often the mass of a light one a heavy one that moves may have. Where it rests on the light
// one, more makes the solver leave out steps, which lets it sink in.
constexpr double kMostMassRatio = 1000.0;
constexpr double kMostMassRatioOfRigid = 100.0;  // where the light one is rigid

// Smallest radius of a ball that cannot pass between samples, in their spacing.
constexpr double kLeastBallRadius = 1.5;

bool touches_itself(const ContactPair& pair) noexcept {
  return pair.other() == pair.object();
}

// Both sides of an object's contacts with itself are its own: of these half as many.
int contacts_of_pair(std::size_t pairs, bool itself) noexcept {
  if (pairs > kFewPairs) return kMostOfMany;
  return pairs > 1 || itself ? kMaxBodyContacts / 2 : kMaxBodyContacts;
}

// Of two surfaces: the geometric mean of their coefficients.
double mixed(double a, double b) noexcept {
  return a == 0.0 || b == 0.0 ? 0.0 : std::sqrt(a * b);
}

Friction mixed(const Friction& a, const Friction& b) noexcept {
  return {mixed(a.static_, b.static_), mixed(a.kinetic, b.kinetic)};
}

std::string in_millimetres(double length) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f mm", 1000.0 * length);
  return text.data();
}

// Two objects, in words.
std::string pair_name(const SimulationConfig& config, int one, int other) {
  const auto first = static_cast<std::size_t>(std::min(one, other));
  const auto second = static_cast<std::size_t>(std::max(one, other));
  const std::string& a = config.objects[first].name;
  const std::string& b = config.objects[second].name;
  if (!a.empty() && !b.empty()) return "objects \"" + a + "\" and \"" + b + "\"";
  return object_name(config, first) + " and " + object_name(config, second);
}

// Both bodies of a pair, in words.
std::string pair_name(const SimulationConfig& config, const ContactPair& pair) {
  if (pair.other() >= 0) return pair_name(config, pair.object(), pair.other());
  const auto scenery = static_cast<std::size_t>(-1 - pair.other());
  return object_name(config, static_cast<std::size_t>(pair.object())) + " and scenery \"" +
         config.scenery[scenery].name + "\"";
}

}  // namespace

WorldContacts::WorldContacts(const SimulationConfig& config,
                             const std::vector<std::unique_ptr<SoftObject>>& objects)
    : dt_(objects.front()->model().dt), leader_(objects.size(), 0) {
  for (const SceneryConfig& scenery : config.scenery) {
    scenery_.push_back({scenery});
    if (scenery_.back().moves()) scenery_.back().go_on(0.0);
  }
  for (const SimulationStylus& stylus : config.styluses) {
    balls_.push_back(stylus.has_ball()
                         ? std::make_unique<StylusBall>(stylus.radius, stylus.coupling_stiffness)
                         : nullptr);
  }
  const bool several = touches_others(config) || has_balls(config);
  if (several && config.floor && objects.size() > kMostOnFloor) {
    throw Error("floor",
                "is for at most " + std::to_string(kMostOnFloor) +
                    " objects that touch each other or balls of styluses",
                std::string("use a [[scenery]] with a plane instead, or set ") +
                    (has_balls(config) ? "stylus.shape = \"patch\" and " : "") +
                    "contact.between_objects = false");
  }
  for (const auto& object : objects) objects_.push_back(object.get());
  for (SoftObject* const object : objects_) {
    const Shape& shape = shape_of(config, *object);
    if (shape.compliance) object->set_contact_shape(*shape.sampling, *shape.compliance);
    bodies_.push_back(
        {*shape.sampling, object->surface(), object->deformed_surface(), object->motion()});
  }
  add_pairs(config);
  const bool itself = std::any_of(pairs_.begin(), pairs_.end(),
                                  [](const auto& pair) { return touches_itself(*pair); });
  const int most = contacts_of_pair(pairs_.size(), itself);
  for (const auto& pair : pairs_) pair->set_most(most);
  suspended_.assign(pairs_.size(), 0);
  const auto others = static_cast<int>(objects_.size() - 1 + scenery_.size() + balls_.size());
  const int with_others = std::min(kMaxBodyContacts, 2 * others * most);
  island_ = std::make_unique<ContactIsland>(static_cast<int>(objects_.size()), capacity(config),
                                            with_others + (itself ? 2 * most : 0),
                                            static_cast<int>(pairs_.size()));
  members_.reserve(objects_.size());
  contacts_.reserve(kMaxBodyContacts);
  solved_.reserve(kMaxBodyContacts);
  held_.reserve(kMaxBodyContacts);
  refuse_overlaps(config);
}

// Of the largest island, with one for the friction of each pair.
int WorldContacts::capacity(const SimulationConfig& config) const {
  int own = 0;
  for (SoftObject* const object : objects_) {
    const int more = object->problem().capacity();
    own = touches_others(config) || has_balls(config) ? own + more : std::max(own, more);
  }
  return own + kMaxBodyContacts + static_cast<int>(pairs_.size());
}

const WorldContacts::Shape& WorldContacts::shape_of(const SimulationConfig& config,
                                                    SoftObject& object) {
  for (const Shape& shape : shapes_) {
    if (shape.model == &object.model()) return shape;
  }
  Shape shape{&object.model(), nullptr, nullptr, nullptr};
  shape.sampling = make_sampling(config, object.model(), object.surface());
  if (config.self_contact && !is_rigid(object.model())) {
    shape.self = std::make_unique<SelfReach>(object.surface(), *shape.sampling);
    if (!shape.self->any()) shape.self.reset();
  }
  if (touches_others(config) || has_balls(config) || shape.self) {
    shape.compliance = std::make_unique<PatchCompliance>(object.model(), *shape.sampling);
  }
  shapes_.push_back(std::move(shape));
  return shapes_.back();
}

// Of two objects the one with the finer sampling gives the patches; both give their edges. An
// object with itself comes last.
void WorldContacts::add_pairs(const SimulationConfig& config) {
  const int count = static_cast<int>(objects_.size());
  const double dt = objects_.front()->model().dt;
  for (int a = 0; a < count && touches_others(config); ++a) {
    const ContactBody& one = bodies_[static_cast<std::size_t>(a)];
    for (int b = a + 1; b < count; ++b) {
      const ContactBody& two = bodies_[static_cast<std::size_t>(b)];
      if (!objects_[static_cast<std::size_t>(a)]->rigid().moves() &&
          !objects_[static_cast<std::size_t>(b)]->rigid().moves() &&
          is_rigid(objects_[static_cast<std::size_t>(a)]->model()) &&
          is_rigid(objects_[static_cast<std::size_t>(b)]->model())) {
        continue;
      }
      check_masses(config, a, b);
      const bool second = two.sampling.spacing() < one.sampling.spacing();
      pairs_.push_back(std::make_unique<BodyContacts>(a, one, b, two, dt,
                                                      second ? one.sampling.first_edge() : 0));
      pairs_.push_back(std::make_unique<BodyContacts>(b, two, a, one, dt,
                                                      second ? 0 : two.sampling.first_edge()));
    }
    add_scenery(config, a);
  }
  for (int a = 0; a < count; ++a) add_balls(config, a);
  for (int a = 0; a < count; ++a) {
    const auto index = static_cast<std::size_t>(a);
    const Shape& shape = shape_of(config, *objects_[index]);
    if (!shape.self) continue;
    pairs_.push_back(std::make_unique<BodyContacts>(a, bodies_[index], *shape.self, dt));
  }
}

void WorldContacts::add_scenery(const SimulationConfig& config, int object) {
  const SoftObject& soft = *objects_[static_cast<std::size_t>(object)];
  for (std::size_t i = 0; i < scenery_.size(); ++i) {
    const bool yields = scenery_[i].moves() && !is_rigid(soft.model());
    if (!soft.rigid().moves() && !yields) continue;
    add_pair(config, object, -1 - static_cast<int>(i), scenery_[i],
             "scenery \"" + config.scenery[i].name + "\"");
  }
}

void WorldContacts::add_balls(const SimulationConfig& config, int object) {
  const SoftObject& soft = *objects_[static_cast<std::size_t>(object)];
  for (std::size_t s = 0; s < balls_.size(); ++s) {
    if (!balls_[s]) continue;
    const std::string name = "stylus " + std::to_string(s + 1);
    if (balls_[s]->compliance() <= 0.0 && is_rigid(soft.model())) {
      throw Error(name,
                  "has a ball without a spring, but " +
                      object_name(config, static_cast<std::size_t>(object)) + " is rigid",
                  "set coupling_stiffness, for instance to 1000 (N/m)");
    }
    ContactPair& pair = add_pair(config, object, ball_number(config, s), balls_[s]->body(), name);
    pair.set_spring_compliance(balls_[s]->compliance());
  }
}

// A ball presses on samples that suit its radius, if the object has such.
// @param name of the other body, for messages
ContactPair& WorldContacts::add_pair(const SimulationConfig& config, int object, int other,
                                     const SceneryStep& there, const std::string& name) {
  const ContactBody& body = bodies_[static_cast<std::size_t>(object)];
  const SoftObject& soft = *objects_[static_cast<std::size_t>(object)];
  const SphereShape* const ball = std::get_if<SphereShape>(&there.now.shape);
  if (ball == nullptr || body.sampling.ball(ball->radius).count == 0) {
    pairs_.push_back(std::make_unique<BodyContacts>(object, body, other, there, dt_));
    return *pairs_.back();
  }
  const double least = kLeastBallRadius * body.sampling.ball(ball->radius).spacing;
  if (ball->radius < least) {  // it could pass between the samples
    throw Error(name,
                "has a radius of " + in_millimetres(ball->radius) + ", too small to touch " +
                    object_name(config, static_cast<std::size_t>(object)),
                "use a radius of at least " + in_millimetres(least) + " or a smaller object" +
                    (there.led ? "" : ", or set contact.between_objects = false"));
  }
  pairs_.push_back(
      std::make_unique<BallContacts>(object, body, soft.contact_compliance(), other, there, dt_));
  return *pairs_.back();
}

void WorldContacts::check_masses(const SimulationConfig& config, int a, int b) const {
  const SoftObject* light = objects_[static_cast<std::size_t>(a)];
  const SoftObject* heavy = objects_[static_cast<std::size_t>(b)];
  if (!light->rigid().moves() || !heavy->rigid().moves()) return;
  if (heavy->rigid().mass() < light->rigid().mass()) std::swap(light, heavy);
  const double most = is_rigid(light->model()) ? kMostMassRatioOfRigid : kMostMassRatio;
  const double ratio = heavy->rigid().mass() / light->rigid().mass();
  if (ratio <= most) return;
  throw Error("scene",
              pair_name(config, a, b) + " have masses of 1 : " + number_text(ratio) +
                  ", of which the light one cannot carry the heavy one",
              "use at most 1 : " + number_text(kMostMassRatio) +
                  ", 1 : " + number_text(kMostMassRatioOfRigid) +
                  " where the light one is rigid, or set contact.between_objects = false");
}

void WorldContacts::refuse_overlaps(const SimulationConfig& config) {
  const std::vector<StylusCommand> nobody(config.styluses.size());
  auto record = std::make_unique<ObjectRecord>();
  for (SoftObject* const object : objects_) object->begin(nobody, *record);
  for (const auto& pair : pairs_) {
    if (ball_of(*pair) != nullptr) continue;
    const double depth = pair->initial_depth();
    if (depth <= kDeepestOverlap) continue;
    throw Error("scene",
                pair_name(config, *pair) + " are inside one another by " + in_millimetres(depth) +
                    " at the start",
                "move them apart, or set contact.between_objects = false");
  }
  for (SoftObject* const object : objects_) object->reset();
}

void WorldContacts::begin_step(std::span<const StylusCommand> commands) noexcept {
  ++steps_;
  for (SceneryStep& scenery : scenery_) {
    if (scenery.moves()) scenery.go_on(static_cast<double>(steps_) * dt_);
  }
  for (std::size_t s = 0; s < balls_.size(); ++s) {
    if (!balls_[s] || balls_[s]->begin(commands[s])) continue;
    for (const auto& pair : pairs_) {
      if (ball_of(*pair) == balls_[s].get()) pair->reset();
    }
  }
}

void WorldContacts::reset() noexcept {
  steps_ = 0;
  for (SceneryStep& scenery : scenery_) {
    if (scenery.moves()) scenery.go_on(0.0);
  }
  for (const auto& ball : balls_) {
    if (ball) ball->reset();
  }
  for (const auto& pair : pairs_) pair->reset();
}

void WorldContacts::archive(StateArchive& state) {
  state.value(steps_);
  for (SceneryStep& scenery : scenery_) {
    for (Vector3* place : {&scenery.now.position, &scenery.before, &scenery.origin}) {
      state.value(*place);
    }
    for (Quaternion* turn : {&scenery.now.orientation, &scenery.turn}) state.value(*turn);
  }
  for (const auto& ball : balls_) {
    if (ball) ball->archive(state);
  }
  state.same(pairs_.size());
  for (const auto& pair : pairs_) pair->archive(state);
  state.values(suspended_);
  state.list(held_);
}

void WorldContacts::hold(const StepRecord& record) noexcept {
  held_.clear();
  for (const BodyContactRecord& contact : record.body_contacts()) {
    if (!asleep(contact.object)) continue;
    held_.push_back(contact);
    held_.back().slip.setZero();
  }
}

void WorldContacts::release_awake() noexcept {
  std::erase_if(held_, [&](const BodyContactRecord& held) { return !asleep(held.object); });
}

Friction WorldContacts::friction(const ContactPair& pair) const noexcept {
  const Friction& own = objects_[static_cast<std::size_t>(pair.object())]->friction();
  if (ball_of(pair) != nullptr) return own;
  if (pair.other() < 0) {
    return scenery_[static_cast<std::size_t>(-1 - pair.other())].now.friction;
  }
  return mixed(own, objects_[static_cast<std::size_t>(pair.other())]->friction());
}

void WorldContacts::find_islands() noexcept {
  std::iota(leader_.begin(), leader_.end(), 0);
  const auto join = [&](int one, int other) {
    const int a = leader_[static_cast<std::size_t>(one)];
    const int b = leader_[static_cast<std::size_t>(other)];
    std::replace(leader_.begin(), leader_.end(), std::max(a, b), std::min(a, b));
  };
  std::array<int, kMaxStyluses> touched;  // an object that each ball touches
  touched.fill(-1);
  for (const auto& pair : pairs_) {
    if (pair->count() == 0) continue;
    if (pair->other() >= 0) join(pair->object(), pair->other());
    const int s = -1 - pair->other() - static_cast<int>(scenery_.size());
    if (s < 0) continue;
    int& other = touched[static_cast<std::size_t>(s)];
    if (other < 0) other = pair->object();
    join(pair->object(), other);
  }
}

void WorldContacts::solve_island(int leader, StepRecord& record) noexcept {
  members_.clear();
  for (int i = 0; i < static_cast<int>(objects_.size()); ++i) {
    if (leader_[static_cast<std::size_t>(i)] == leader) members_.push_back(i);
  }
  contacts_.clear();
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    ContactPair& pair = *pairs_[p];
    if (leader_[static_cast<std::size_t>(pair.object())] != leader) continue;
    for (int i = 0; i < pair.count(); ++i) {
      if (contacts_.size() + solved_.size() + held_.size() == kMaxBodyContacts) break;
      const std::uint64_t sample = static_cast<std::uint64_t>(pair.contact(i).sample);
      contacts_.push_back(
          {&pair, i, (static_cast<std::uint64_t>(p) << 32) + sample, friction(pair)});
    }
  }
  if (contacts_.empty()) {
    for (const int i : members_) {
      const auto index = static_cast<std::size_t>(i);
      objects_[index]->solve(record.object[index]);
    }
    return;
  }
  const ContactSolution solution = island_->solve(objects_, members_, contacts_);
  for (const int i : members_) {
    const auto index = static_cast<std::size_t>(i);
    objects_[index]->accept(solution, record.object[index]);
  }
  solved_.insert(solved_.end(), contacts_.begin(), contacts_.end());
}

// The forces act where the sample is half-way through the step, on both: so angular momentum is
// kept to rounding.
void WorldContacts::apply(std::span<const IslandContact> contacts, StepRecord& record) noexcept {
  std::array<Vector3, kMaxObjects> sums;
  std::array<Vector3, kMaxObjects> halfway;
  sums.fill(Vector3::Zero());
  for (const IslandContact& contact : contacts) {
    sums[static_cast<std::size_t>(contact.pair->object())] += contact.solved.force;
    if (contact.pair->other() < 0) continue;
    sums[static_cast<std::size_t>(contact.pair->other())] -= contact.solved.force;
  }
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    halfway[i] = objects_[i]->halfway_position(sums[i]);
  }
  record.body_contact.clear();
  for (const IslandContact& contact : contacts) {
    if (contact.solved.mode == ContactMode::kOpen) continue;
    BodyContactRecord& out = record.body_contact.emplace_back();
    contact.pair->write(contact.i, contact.solved, out);
    const auto object = static_cast<std::size_t>(out.object);
    const Vector3 arm = objects_[object]->motion().halfway * contact.pair->contact(contact.i).arm;
    out.position = halfway[object] + arm;
    objects_[object]->touch(out, true, arm);
    if (out.other < 0) continue;
    const auto other = static_cast<std::size_t>(out.other);
    objects_[other]->touch(out, false, out.position - halfway[other]);
  }
}

void WorldContacts::solve(StepRecord& record) noexcept {
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    if (!rests(*pairs_[p]) && !suspended(p)) pairs_[p]->find();
  }
  find_islands();
  solved_.clear();
  for (int i = 0; i < static_cast<int>(objects_.size()); ++i) {
    if (leader_[static_cast<std::size_t>(i)] == i && !asleep(i)) solve_island(i, record);
  }
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (!objects_[i]->asleep()) objects_[i]->write(record.object[i]);
  }
  apply(solved_, record);
  end_balls(record);
  for (const BodyContactRecord& held : held_) record.body_contact.push_back(held);
  for (const IslandContact& contact : solved_) {
    if (contact.found) {
      contact.pair->update(contact.i, contact.solved, contact.yielded);
    } else {
      contact.pair->skip(contact.i);
    }
  }
}

void WorldContacts::end_balls(const StepRecord& record) noexcept {
  for (std::size_t s = 0; s < balls_.size(); ++s) {
    StylusBall* const ball = balls_[s].get();
    if (ball == nullptr) continue;
    Vector3 force = Vector3::Zero();
    Vector3 held = Vector3::Zero();
    StylusBall::Touch strongest;
    bool solved = true;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      StylusBall::Touch touch{static_cast<int>(i), Vector3::Zero(), Vector3::Zero()};
      double weights = 0.0;
      for (const IslandContact& contact : solved_) {
        if (contact.pair->object() != touch.object) continue;
        if (ball_of(*contact.pair) != ball) continue;
        solved = solved && contact.found;
        if (contact.solved.mode == ContactMode::kOpen) continue;
        touch.force += contact.solved.force;
        const double weight = contact.solved.force.norm();
        const int sample = contact.pair->contact(contact.i).sample;
        touch.middle += weight * bodies_[i].sampling.rest_position(sample);
        weights += weight;
      }
      force += touch.force;
      const ContactRecord& hold = record.object[i].contact[s];
      if (hold.state != ContactState::kFree) held += objects_[i]->motion().halfway * hold.force;
      if (weights <= 0.0 || touch.force.norm() <= strongest.force.norm()) continue;
      touch.middle /= weights;
      strongest = touch;
    }
    ball->end(force, held, strongest, solved);
  }
}

std::optional<BallGrip> WorldContacts::grip(std::size_t s) const noexcept {
  const StylusBall::Touch& touch = balls_[s]->strongest();
  if (touch.object < 0) return std::nullopt;
  const auto object = static_cast<std::size_t>(touch.object);
  const SurfaceLocation at = bodies_[object].rest.closest(touch.middle);
  return BallGrip{touch.object, at.triangle, at.point,
                  objects_[object]->motion().halfway.conjugate() * touch.force};
}

// A ball has no contacts with an object that it holds: the grip takes their place.
bool WorldContacts::suspended(std::size_t pair) noexcept {
  const int s = -1 - pairs_[pair]->other() - static_cast<int>(scenery_.size());
  if (s < 0) return false;
  const auto object = static_cast<std::size_t>(pairs_[pair]->object());
  const bool held = objects_[object]->held_by(static_cast<std::size_t>(s));
  if (held && suspended_[pair] == 0) pairs_[pair]->reset();
  suspended_[pair] = held ? 1 : 0;
  return held;
}

}  // namespace irdm
