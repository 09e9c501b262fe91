#include "simulation/step/soft_object.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "simulation/state/state_archive.hpp"
#include "simulation/step/settings.hpp"

namespace irdm {
namespace {

// The iteration goes on in the next step from where it was left, so a few sweeps are enough.
constexpr SolverLimits kFloorLimits{200, 1e-10, 8, 1e-6, 1e-4};

}  // namespace

SoftObject::SoftObject(const SimulationObject& object, const SimulationConfig& config, int number)
    : body_(object, config.gravity),
      rest_(model().mesh),
      surface_(rest_),
      friction_(object.friction),
      contacts_(config, model().dt, number, rest_, surface_),
      problem_(kMaxContacts + (config.floor ? kMaxFloorContacts : 0)),
      solver_(problem_.capacity()),
      nodal_(kMaxContacts * kMaxPatchNodes + kMaxFloorContacts +
             static_cast<std::size_t>(rest_.node_count())),
      touched_(rest_.node_count()) {
  account_.begin(total_energy());
  check_inertial_loading(model(), object.inertial_loading, "object");
  if (config.floor && body_.rigid().moves()) {
    floor_ = std::make_unique<FloorContacts>(*config.floor, rest_, model());
  }
}

void SoftObject::reset() noexcept {
  change_ = Change::kUnknown;
  body_.reset();
  body_.lead({});
  account_.begin(total_energy());
  contacts_.reset();
  if (floor_) floor_->reset();
  touched_.clear();
  touched_as_ = {};
}

// The problem of the last step is not in it: only contact models look back at that.
void SoftObject::archive(StateArchive& state) {
  body_.archive(state);
  surface_.archive(state, body_.engine());
  state.value(change_);
  state.value(friction_);
  contacts_.archive(state);
  if (floor_) floor_->archive(state);
  state.value(account_);
  state.value(elastic_);
  state.value(late_);
  state.value(asleep_);
  state.value(limited_late_);
  if (!state.reading()) return;
  problem_.begin(0);
  touched_.clear();
  touched_as_ = {};
}

void SoftObject::set_contact_shape(const ContactSampling& sampling,
                                   const PatchCompliance& compliance) {
  sampling_ = &sampling;
  compliance_ = &compliance;
}

void SoftObject::set(const Vector3& gravity, const ObjectSettings& settings) noexcept {
  change_ = Change::kUnknown;
  friction_ = settings.friction;
  body_.set(gravity, settings);
  account_.set_energy(total_energy());
}

void SoftObject::begin(std::span<const StylusCommand> commands, ObjectRecord& record) noexcept {
  record.asleep = false;
  body_.begin_step(record);
  update_surface(!record.spin.isZero(0.0));
  prefetch_columns(commands);
  const int floor_count = find_contacts(commands);
  pose(commands, floor_count, record);
  touched_.clear();
  touched_as_ = {};
}

void SoftObject::fall_asleep(ObjectRecord& record) noexcept {
  asleep_ = record.asleep = true;
  record.sweeps = 0;
}

void SoftObject::rest(std::span<const StylusCommand> commands, ObjectRecord& record) noexcept {
  body_.rest(record);
  account_.set_energy(total_energy());
  contacts_.find(commands, body_.motion());
}

void SoftObject::write(ObjectRecord& record) noexcept {
  contacts_.write(problem_, record);
  write_floor(record);
  nodal_.clear();
  own_ = {};
  contacts_.end_step(problem_, body_.motion().halfway, nodal_, own_);
  for (int i = 0; floor_ && i < floor_->count(); ++i) {
    const ContactConstraint& solved = problem_.contact(i);
    if (solved.mode == ContactMode::kOpen) continue;
    nodal_.add(floor_->node(i), solved.force);
    own_.add(body_.motion().halfway * solved.force, solved.arm);
  }
}

Vector3 SoftObject::halfway_position(const Vector3& more) const noexcept {
  const FreeMotion& motion = body_.motion();
  if (!body_.rigid().moves()) return motion.position;
  return 0.5 * (motion.start.position +
                body_.rigid().moved(motion.start, motion.force + own_.sum + more));
}

void SoftObject::touch(const BodyContactRecord& contact, bool first, const Vector3& arm) noexcept {
  const Quaternion& halfway = body_.motion().halfway;
  add_body_contact(contact, first, *sampling_, halfway, touched_);
  touched_as_.add(first ? contact.force : Vector3(-contact.force), halfway.conjugate() * arm);
}

Matrix3 SoftObject::compliance_at(int row, const PatchCompliance::Place& from) const noexcept {
  const int floor_count = floor_ ? floor_->count() : 0;
  if (row < floor_count) return compliance_->at_node(floor_->node(row), from);
  const ContactPatch& patch = contacts_.patch(row - floor_count);
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
    sum += patch.weights[i] * compliance_->at_node(patch.nodes[i], from);
  }
  return sum;
}

void SoftObject::finish(std::span<const StylusCommand> commands, ObjectRecord& record) noexcept {
  contacts_.update(commands, body_.motion(), problem_);
  if (floor_) floor_->update_contacts(body_.motion(), problem_);
  const RigidState before = state();
  end_step(record);
  const double elastic = elastic_;
  const double energy = total_energy();
  // What other bodies' forces do in the elastic motion is not known.
  if (!touched_as_.sum.isZero(0.0)) account_.set_energy(account_.energy() + elastic_ - elastic);
  account_.settle(contacts_.work() + work_of_touch(before) + body_.coupling_work(), energy);
  late_ = {};
  account_.forgive(model().dt, contacts_.count() > 0);
  for (ContactRecord& contact : record.contact) {
    if (contact.state != ContactState::kFree) {
      contact.proxy = state().position + state().orientation * contact.proxy;
    }
  }
}

void SoftObject::prefetch_columns(std::span<const StylusCommand> commands) noexcept {
  if (body_.capabilities().columns == nullptr) return;
  std::array<Vector3, kMaxStyluses> tips;
  std::size_t count = 0;
  for (const StylusCommand& command : commands) {
    if (!command.present || !command.tip.allFinite()) continue;
    tips[count++] = body_.motion().to_body(command.tip);
  }
  body_.capabilities().columns->prefetch({tips.data(), count});
}

// Returns how many of them are the floor's.
int SoftObject::find_contacts(std::span<const StylusCommand> commands) noexcept {
  contacts_.find(commands, body_.motion());
  return floor_ ? floor_->find(body_.motion(), surface_, contacts_.displaced()) : 0;
}

// What other bodies' forces did on the body as a whole in the step [J].
double SoftObject::work_of_touch(const RigidState& before) const noexcept {
  if (touched_as_.sum.isZero(0.0) && touched_as_.arms.isZero(0.0)) return 0.0;
  const Quaternion& halfway = body_.motion().halfway;
  const Vector3 turn =
      0.5 * model().dt *
      (body_.rigid().angular_velocity(before) + body_.rigid().angular_velocity(state()));
  return touched_as_.sum.dot(state().position - before.position) +
         touched_as_.torque(halfway).dot(turn);
}

// Steps 1 to 3: where the contacts' points are wanted, and how they answer.
void SoftObject::pose(std::span<const StylusCommand> commands, int floor_count,
                      ObjectRecord& record) noexcept {
  record.residual = 0.0;
  record.sweeps = 0;
  record.solved = true;
  problem_.begin(floor_count + contacts_.count());
  if (problem_.count() == 0) return;
  problem_.rigid = body_.rigid().mobility();
  contacts_.predict(body_.engine());
  if (floor_count > 0) pose_floor();
  contacts_.pose(commands, body_.motion(), friction_, account_, body_.engine(), floor_count,
                 problem_);
}

// Step 4: the forces that take them there.
void SoftObject::solve(ObjectRecord& record) noexcept {
  if (problem_.count() == 0) return;
  const bool on_floor = floor_ && floor_->count() > 0;
  accept(solver_.solve(problem_, on_floor ? kFloorLimits : SolverLimits{}), record);
}

void SoftObject::accept(const ContactSolution& solution, ObjectRecord& record) noexcept {
  contacts_.solve_bridged(problem_);
  record.residual = solution.residual;
  record.sweeps = solution.sweeps;
  record.solved = solution.solved;
}

// The floor's contacts come first; what it has in common with the styluses follows.
void SoftObject::pose_floor() noexcept {
  floor_->pose(body_.motion(), surface_, problem_);
  const int floor_count = floor_->count();
  for (int a = 0; a < contacts_.count(); ++a) {
    for (int i = 0; i < floor_count; ++i) {
      const Matrix3 shared = floor_->between(contacts_.patch(a), i);
      problem_.elastic(floor_count + a, i) = shared;
      problem_.elastic(i, floor_count + a) = shared.transpose();
    }
  }
}

// The floor's forces, rounded to what is recorded; this is what acts.
void SoftObject::write_floor(ObjectRecord& record) noexcept {
  record.floor_count = 0;
  record.floor_force.setZero();
  for (int i = 0; floor_ && i < floor_->count(); ++i) {
    ContactConstraint& solved = problem_.contact(i);
    if (solved.mode == ContactMode::kOpen) continue;
    FloorForce& out = record.floor[static_cast<std::size_t>(record.floor_count++)];
    out = {floor_->node(i), solved.force.cast<float>()};
    solved.force = out.force.cast<double>();
    record.floor_force += body_.motion().halfway * solved.force;
  }
}

// Step 5: the forces enter the history, and the rigid motion goes on.
void SoftObject::end_step(ObjectRecord& record) noexcept {
  touched_.add_to(nodal_);
  RigidStateHistory::Forces forces = own_;
  forces.sum += touched_as_.sum;
  forces.arms += touched_as_.arms;
  cache_nodes();
  body_.end_step(nodal_.view(), forces, record);
  if (change_ == Change::kNone) change_ = Change::kStep;
}

// What this step looked at, the next one will look at again.
void SoftObject::cache_nodes() noexcept {
  PredictionCaching* const caching = body_.capabilities().caching;
  if (caching == nullptr) return;
  caching->cache_nodes(surface_.seen());
  for (int a = 0; a < contacts_.count(); ++a) {
    const ContactPatch& patch = contacts_.patch(a);
    caching->cache_nodes(std::span(patch.nodes).first(static_cast<std::size_t>(patch.count)));
  }
}

// What is found of the surface between steps the coming step need not find again.
// @param loaded by its own motion, which changes the response, too
void SoftObject::update_surface(bool loaded) noexcept {
  const Change change = std::exchange(change_, loaded ? Change::kUnknown : Change::kNone);
  double bound = DeformedSurface::kUnknown;
  if (!loaded && change == Change::kNone) bound = 0.0;
  if (!loaded && change == Change::kStep && surface_.queried()) {
    bound = body_.engine().free_change_bound();
  }
  surface_.begin_step(body_.engine(), bound);
}

// What acts on the object besides one stylus: into nodal_, and its sums into the model.
void SoftObject::collect_others(std::size_t s, ContactModel& model) noexcept {
  nodal_.clear();
  model.other_force.setZero();
  model.other_torque.setZero();
  for (int i = 0; floor_ && i < std::min(floor_->count(), problem_.count()); ++i) {
    const ContactConstraint& solved = problem_.contact(i);
    if (solved.mode == ContactMode::kOpen) continue;
    nodal_.add(floor_->node(i), solved.force);
    model.other_force += solved.force;
    model.other_torque += solved.arm.cross(solved.force);
  }
  contacts_.add_others(s, problem_, nodal_, model);
  const Quaternion& halfway = body_.motion().halfway;
  touched_.add_to(nodal_);
  model.other_force += halfway.conjugate() * touched_as_.sum;
  model.other_torque += halfway.conjugate() * touched_as_.torque(halfway);
  model.other_force += halfway.conjugate() * body_.coupling().force;
  model.other_torque += halfway.conjugate() * body_.coupling_torque();
}

// Of the rigid motion, and of the elastic one where the engine knows it.
double SoftObject::total_energy() noexcept {
  const double elastic = body_.engine().energy();
  elastic_ = std::isnan(elastic) ? 0.0 : elastic;
  return body_.energy() + elastic_;
}

// The balance, and what the object may lose to hands within the horizon, as it comes or falls: one
// part for each stylus that touches it. The motion's fades with the driving share.
double SoftObject::available_energy(const ContactModel& model) const noexcept {
  const RigidBody& body = body_.rigid();
  double motion = 0.0;
  if (body.moves()) {
    const double power = body.mass() * model.free_forces.gravity.dot(model.motion.velocity);
    const double falling = std::max(0.0, power) * model.horizon * model.dt;
    motion = rigid_energy(body, FreeForces{}, model.motion) + falling;
  }
  const double balance = account_.balance();
  const double left = std::max(balance, 0.0) + elastic_ + EnergyAccount::kAllowance +
                      account_.driving_share() * motion;
  return left / std::max(1, contacts_.count()) + std::min(balance, 0.0);
}

// What takes long and rests on the patches alone is made ready first; the path comes last. A
// contact has all of it in one step, a free tip can wait for its parts.
bool SoftObject::prepare_horizon(const ContactPatch& patch, bool among_others, ContactModel& model,
                                 int& budget) noexcept {
  ResponseEngine& engine = body_.engine();
  const auto steps = static_cast<std::size_t>(model.horizon);
  const bool in_parts = model.state == ContactState::kFree;
  bool spent = false;
  const auto spend = [&] { return (std::exchange(spent, true) && !in_parts) || budget-- > 0; };
  const auto prepare = [&](const ContactPatch& one) {
    if (engine.keeps_response(one, steps)) return true;
    if (!spend()) return false;
    engine.prepare_response(one, steps);
    return true;
  };
  if (!prepare(patch) || (among_others && !prepare(other_.patch))) return false;
  if (among_others && !engine.keeps_cross_response(patch, other_.patch, steps)) {
    if (!spend()) return false;
    engine.cross_response(patch, other_.patch, {model.response.data(), steps});
  }
  return (!among_others && engine.keeps_horizon(patch, steps)) || spend();
}

bool SoftObject::predict_horizon(std::size_t s, const Vector3& tip, int horizon,
                                 ContactModel& model, int& budget) noexcept {
  model.state = contacts_.state(s);
  model.valid = contacts_.may_touch(s);
  if (!model.valid) return true;
  model.horizon = std::clamp(horizon, 1, kMaxHorizon);
  model.friction = friction_;
  model.body = this->model().body;
  model.motion = state();
  model.free_forces = body_.free_forces();
  model.energy = available_energy(model);
  update_surface(false);
  ContactPatch patch;
  if (!contacts_.locate(s, body_.next_motion().to_body(tip), model, patch, budget)) return false;
  const auto count = static_cast<std::size_t>(model.horizon);
  const bool among_others = contacts_.find_other(s, friction_, problem_, other_);
  if (!prepare_horizon(patch, among_others, model, budget)) return false;
  contacts_.end_prediction(s, patch);
  collect_others(s, model);
  body_.engine().predict_horizon(patch, nodal_.view(), {model.path.data(), count},
                                 {model.response.data(), count});
  if (among_others) {
    assembly_.answer(other_, model, patch, contacts_.average(s), nodal_.view(), body_.engine());
  }
  model.valid = contacts_.write_series(s, body_.rigid().mobility(), model);
  return true;
}

bool SoftObject::insert_delayed_force(std::size_t s, const AppliedForce& applied,
                                      LateForce& entry) noexcept {
  if (entry.age >= body_.past().count()) return false;
  update_surface(false);
  const FreeMotion motion = body_.next_motion();
  const Vector3 tip = motion.to_body(applied.tip);
  if (!contacts_.locate_delayed(s, tip, applied.arm, entry)) return false;
  const Vector3 force = floor_ ? floor_->without_pressure(applied.force) : applied.force;
  entry.force = body_.past().halfway(entry.age).conjugate() * force;
  const double share = share_of_late(force, entry);
  entry.force *= share;
  limited_late_ += share < 1.0 ? 1 : 0;
  return insert_delayed_force(entry);
}

// By the object's account. The motion does not have the late forces before this one yet.
// @param force [N], W
double SoftObject::share_of_late(const Vector3& force, const LateForce& entry) noexcept {
  const auto s = static_cast<std::size_t>(entry.stylus);
  const FreeMotion motion = body_.next_motion();
  const RigidMobility mobility = body_.rigid().mobility();
  const Quaternion to_body = motion.halfway.conjugate();
  const Vector3 turn = mobility.rotation * (to_body * late_.torque(motion.halfway));
  const Vector3 before = mobility.translation * (to_body * late_.sum) + turn.cross(entry.arm);
  const Vector3 way = motion.way(entry.arm) + motion.halfway * (2.0 * before);
  nodal_.clear();
  contacts_.spread(s, entry.point, entry.force, nodal_);
  const EnergyChange elastic =
      body_.engine().energy_change(nodal_.view(), entry.age).value_or(EnergyChange{});
  const double along = force.dot(way) + elastic.along;
  const double own =
      entry.force.dot(mobility.between(entry.arm, entry.arm) * entry.force) + elastic.own;
  const double share = account_.enter(along, own, contacts_.unsettled_work(s, force, entry.age));
  late_.add(share * force, entry.arm);
  return share;
}

// What acts is the entry: a run that is rerun has nothing else.
bool SoftObject::insert_delayed_force(const LateForce& entry) noexcept {
  if (entry.age >= body_.past().count()) return false;
  nodal_.clear();
  contacts_.spread(static_cast<std::size_t>(entry.stylus), entry.point, entry.force, nodal_);
  body_.insert_delayed_force(nodal_.view(), entry.force, entry.arm, entry.age);
  contacts_.add_delayed(static_cast<std::size_t>(entry.stylus),
                        body_.past().halfway(entry.age) * entry.force, entry.age);
  change_ = Change::kUnknown;
  return true;
}

double SoftObject::distance(const Vector3& tip) noexcept {
  update_surface(false);
  return surface_.closest(body_.next_motion().to_body(tip)).signed_distance;
}

}  // namespace irdm
