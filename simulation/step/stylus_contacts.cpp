#include "simulation/step/stylus_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/contact/contact_problem.hpp"
#include "common/error.hpp"
#include "simulation/step/stylus_patch.hpp"

namespace irdm {
namespace {

// First row of contact i in matrices over the contacts.
Eigen::Index row(int i) {
  return static_cast<Eigen::Index>(3 * i);
}

// Inside the cone of a touching contact.
bool pushes(const ContactConstraint& contact) noexcept {
  const double push = -contact.force.dot(contact.normal);
  const Vector3 along = contact.force + push * contact.normal;
  return push >= 0 &&
         (std::isinf(contact.friction.static_) || along.norm() <= contact.friction.static_ * push);
}

// From the surface, within which a force that comes from elsewhere acts on it [m]: one for this
// step, and one for an earlier step, since when the tip may have gone on.
constexpr double kNear = 0.002;
constexpr double kNearDelayed = 0.005;
// How far the surface may be from where the bridge knows it to be, as a share of the object's size.
constexpr double kFarFromOwn = 1.0;
// Over which the force of a stylus is averaged for the contact models of others [s].
constexpr double kAverageTime = 0.2;
// In which a contact catches up with a tip that has passed an edge [s].
constexpr double kEdgeTime = 0.06;

// Over which the velocity of a tip is smoothed [s].
constexpr double kVelocityTime = 0.004;
// For how many steps it may be told of a contact where it was.
constexpr std::uint64_t kPredictedFor = 8;

// Rounds of finding where a contact begins, and when it is found [m].
constexpr int kProjectionRounds = 8;
constexpr double kProjected = 1e-6;

}  // namespace

StylusContacts::StylusContacts(const SimulationConfig& config, double dt, int object,
                               const RestSurface& rest, DeformedSurface& surface)
    : rest_(rest), surface_(surface), dt_(dt), release_time_(config.release_time), object_(object) {
  const double largest = PressureMask::largest_radius(rest);
  for (const SimulationStylus& tip : config.styluses) {
    const double radius = patch_radius(tip, rest);
    if (radius > largest) {
      throw Error("stylus",
                  "radius " + std::to_string(tip.radius) +
                      " m is too large for an object whose triangles are this small",
                  "use at most " + std::to_string(largest) + " m or a coarser mesh");
    }
    styluses_.push_back({tip, PressureMask(rest, radius), SmoothedSurface(rest, radius)});
  }
  size_ = rest.bounding_radius();
}

void StylusContacts::reset() noexcept {
  for (Stylus& stylus : styluses_) {
    stylus.proxy.forget();
    stylus.displacement = {};
    stylus.last.any = false;
    stylus.last.average.setZero();
    stylus.position.reset();
    stylus.ledger.clear();
    stylus.prediction = {};
  }
}

void StylusContacts::find(std::span<const StylusCommand> commands,
                          const FreeMotion& motion) noexcept {
  count_ = 0;
  work_ = std::exchange(late_work_, 0.0);
  for (std::size_t s = 0; s < styluses_.size(); ++s) {
    const StylusCommand& command = commands[s];
    Stylus& stylus = styluses_[s];
    stylus.share = 1.0;
    follow(stylus, command);
    if (!command.present || !command.tip.allFinite()) {
      stylus.proxy.forget();
      continue;
    }
    if (!find_contact(stylus, command, motion.to_body(command.tip))) continue;
    const auto a = static_cast<std::size_t>(count_++);
    Contact& contact = contacts_[a];
    contact = {.stylus = static_cast<int>(s),
               .given = command.given.has_value(),
               .bridged = command.bridged.has_value(),
               .point = stylus.proxy.point()};
    stylus.mask.spread(contact.point, patches_[a]);
    if (stylus.proxy.state() != ContactState::kTouching || contact.given) continue;
    const SmoothedSurface::Place place = stylus.felt.at(contact.point);
    contact.normal = place.normal;
    stylus.proxy.set_inset(place.position -
                           mean(patches_[a], [&](int i) { return rest_.node(i); }));
  }
}

// The way of its tip, and the work of its bridge's forces on it. Of a step with neither nothing was
// told.
void StylusContacts::follow(Stylus& stylus, const StylusCommand& command) noexcept {
  if (!command.present || !command.tip.allFinite()) {
    stylus.position.reset();
    stylus.velocity.setZero();
    stylus.ledger.clear();
    return;
  }
  stylus.way = command.tip - std::exchange(stylus.position, command.tip).value_or(command.tip);
  stylus.velocity += std::min(1.0, dt_ / kVelocityTime) * (stylus.way / dt_ - stylus.velocity);
  if (!command.bridged) {
    stylus.ledger.clear();
  } else if (!command.bridged->force.isZero(0.0) || !stylus.way.isZero(0.0)) {
    work_ += stylus.ledger.tell(steps_ + 1, command.tip);
  }
}

// Of one stylus that is there. False: none.
bool StylusContacts::find_contact(Stylus& stylus, const StylusCommand& command,
                                  const Vector3& tip) noexcept {
  GodObject& proxy = stylus.proxy;
  if (stylus.tip.has_ball() && !command.given) return find_grip(stylus, command, tip);
  if (command.given) {
    if (command.given->object != object_) return false;
    proxy.impose(command.given->contact, command.given->point);
  } else {
    proxy.find({tip, (command.buttons & kGrabButton) != 0, stylus.tip.reach}, surface_);
  }
  if (command.bridged) apply_remote_contact(stylus, *command.bridged, tip);
  if (proxy.state() == ContactState::kFree) return false;
  if (!proxy.fresh() || project_initial_contact(stylus, tip)) return true;
  proxy.reject_contact();
  return false;
}

// A ball makes a contact here only where it takes hold, and until it has let go.
bool StylusContacts::find_grip(Stylus& stylus, const StylusCommand& command,
                               const Vector3& tip) noexcept {
  GodObject& proxy = stylus.proxy;
  stylus.gripped.reset();
  if (proxy.state() != ContactState::kFree) {
    proxy.find({tip, (command.buttons & kGrabButton) != 0, 0.0}, surface_);
  } else if (command.grip && command.grip->object == object_) {
    proxy.impose(ContactState::kHeld, command.grip->triangle, command.grip->point);
    stylus.gripped = command.grip->force;
  }
  return proxy.state() != ContactState::kFree;
}

// The bridge has one object in mind. Its contact with that one may be none by now: its force acts
// where the tip is, if that is near enough.
void StylusContacts::apply_remote_contact(Stylus& stylus, const BridgedForce& bridged,
                                          const Vector3& tip) noexcept {
  GodObject& proxy = stylus.proxy;
  if (bridged.object != object_) {
    if (proxy.state() != ContactState::kFree) proxy.reject_contact();
    return;
  }
  if (proxy.state() != ContactState::kFree || !proxy.outside()) return;
  if (bridged.force.isZero(0.0)) return;
  const SurfaceHit hit = surface_.closest(tip);
  if (std::abs(hit.signed_distance) > proxy.tip_moved() + kNear) return;
  proxy.impose(ContactState::kTouching, hit.triangle, hit.point);
}

// A contact begins where the tip is straight below the surface that it feels: were it drawn aside
// from the start, it would get energy from nowhere. False: it is deeper there than it can have come
// in this step. Such a tip was inside all along, and there is no telling how it got there.
bool StylusContacts::project_initial_contact(Stylus& stylus, const Vector3& tip) noexcept {
  double depth = 0.0;
  for (int round = 0; round < kProjectionRounds; ++round) {
    const SmoothedSurface::Place place = stylus.felt.at(stylus.proxy.point());
    const Vector3 moved = interpolate(
        stylus.proxy.point(), [&](int i) -> Vector3 { return surface_.node(i) - rest_.node(i); });
    const Vector3 gap = tip - place.position - moved;
    depth = -gap.dot(place.normal);
    const Vector3 aside = gap + depth * place.normal;
    if (aside.norm() < kProjected) break;
    stylus.proxy.slide(aside, aside.norm(), rest_);
  }
  return depth <= stylus.proxy.tip_moved() + kDeepestStart;
}

double StylusContacts::displaced() const noexcept {
  double largest = 0.0;
  for (const Stylus& stylus : styluses_) {
    if (stylus.displacement.goes_on_in(steps_)) {
      largest = std::max(largest, stylus.displacement.last().norm());
    }
  }
  return largest;
}

void StylusContacts::predict(ResponseEngine& engine) noexcept {
  if (count_ == 0) return;
  const auto count = static_cast<std::size_t>(count_);
  std::array<Vector3, kMaxContacts> h;
  engine.predict({patches_.data(), count}, {h.data(), count}, elastic_);
  for (std::size_t a = 0; a < count; ++a) {
    contacts_[a].free = h[a];
    contacts_[a].arm = h[a] + mean(patches_[a], [&](int i) { return rest_.node(i); });
  }
}

void StylusContacts::pose(std::span<const StylusCommand> commands, const FreeMotion& motion,
                          const Friction& friction, EnergyAccount& account, ResponseEngine& engine,
                          int first, ContactProblem& problem) noexcept {
  first_ = first;
  for (int a = 0; a < count_; ++a) {
    for (int b = 0; b < count_; ++b) {
      problem.elastic(first + a, first + b) = elastic_.block<3, 3>(row(a), row(b));
    }
    Contact& contact = contacts_[static_cast<std::size_t>(a)];
    pose_contact(contact, commands[static_cast<std::size_t>(contact.stylus)], motion, friction,
                 first + a, problem);
    if (!contact.bridged) continue;
    const auto s = static_cast<std::size_t>(contact.stylus);
    bound_remote_force(*commands[s].bridged, motion, account, engine, first + a, problem);
  }
}

void StylusContacts::pose_contact(Contact& contact, const StylusCommand& command,
                                  const FreeMotion& motion, const Friction& friction, int row,
                                  ContactProblem& problem) noexcept {
  Stylus& stylus = stylus_of(contact);
  const PersistentContact& state = stylus.proxy.contact();
  ContactConstraint& posed = problem.contact(row);
  posed.arm = contact.arm;
  if (contact.given) {
    posed.law = ContactLaw::kGiven;
    posed.force = motion.halfway.conjugate() * command.given->force;
    return;
  }
  // The tip pushes where it is, so that what it does is what the object gets.
  state.pose(contact.normal, friction, contact.arm + stylus.proxy.offset(),
             motion.to_body(command.tip), posed);
  const double stiffness = stylus.tip.coupling_stiffness;
  if (stiffness > 0) problem.elastic(row, row).diagonal().array() += 1.0 / stiffness;
  if (stylus.gripped) {
    // At the offset at which the contact takes over the force that the ball exerted.
    const Vector3 tip = posed.arm + posed.gap;
    posed.arm = tip;
    const Vector3 offset = tip - contact.arm - problem.compliance(row, row) * *stylus.gripped;
    stylus.proxy.set_inset(offset);
    state.pose(contact.normal, friction, contact.arm + offset, tip, posed);
  }
  if (state.releasing()) {
    const double left = state.hold_left(dt_, release_time_);
    if (left > 0) {
      problem.elastic(row, row) += release_compliance(left, problem.compliance(row, row));
    } else {
      posed.law = ContactLaw::kReleased;
    }
  }
  if (!contact.bridged) return;
  contact.law = posed.law;
  posed.law = ContactLaw::kGiven;
  posed.force = motion.halfway.conjugate() * command.bridged->force;
  if (posed.force.isZero(0.0)) return;
  posed.arm = accepted_arm(command.bridged->arm, posed.arm);
}

// What a force at contact a does in the elastic motion during the step. Where the place's
// displacement at its start is not that of the end of the last step, the engine has to say.
EnergyChange StylusContacts::elastic_change(int a, const Vector3& force,
                                            ResponseEngine& engine) noexcept {
  const Contact& contact = contacts_[static_cast<std::size_t>(a)];
  const ContactDisplacement& displacement = stylus_of(contact).displacement;
  const LastContact& last = stylus_of(contact).last;
  const bool same = displacement.goes_on_in(steps_) && !delayed_ &&
                    last.point.nodes == contact.point.nodes &&
                    last.point.weights == contact.point.weights;
  if (!same) {
    const ContactPatch& patch = patches_[static_cast<std::size_t>(a)];
    std::array<NodalForce, kMaxPatchNodes> nodal;
    for (std::size_t i = 0; i < static_cast<std::size_t>(patch.count); ++i) {
      nodal[i] = {patch.nodes[i], patch.weights[i] * force};
    }
    const auto change =
        engine.energy_change({nodal.data(), static_cast<std::size_t>(patch.count)}, -1);
    if (change) return *change;
  }
  const Vector3 start = displacement.goes_on_in(steps_) ? displacement.last() : contact.free;
  return {force.dot(contact.free - start), force.dot(elastic_between(a, a) * force)};
}

// What a force adds to the energy of the motion depends on the forces of other bridges, too:
// those of the rows before it are bounded by then. The account also depends on when news came,
// which a recorded run does not have: it has what was decided.
void StylusContacts::bound_remote_force(const BridgedForce& bridged, const FreeMotion& motion,
                                        EnergyAccount& account, ResponseEngine& engine, int row,
                                        ContactProblem& problem) noexcept {
  ContactConstraint& posed = problem.contact(row);
  if (posed.force.isZero(0.0)) return;
  const int a = row - first_;
  Contact& contact = contacts_[static_cast<std::size_t>(a)];
  Vector3 way = motion.halfway.conjugate() * motion.way(posed.arm);
  for (int b = 0; b < a; ++b) {
    if (!contacts_[static_cast<std::size_t>(b)].bridged) continue;
    const ContactConstraint& other = problem.contact(first_ + b);
    const Matrix3 between = problem.rigid.between(posed.arm, other.arm) + elastic_between(a, b);
    way += 2.0 * between * other.force;
  }
  const EnergyChange elastic = elastic_change(a, posed.force, engine);
  const double along = posed.force.dot(way) + elastic.along;
  const double own =
      posed.force.dot(problem.rigid.between(posed.arm, posed.arm) * posed.force) + elastic.own;
  const double decided = account.drive(along, own, work_);
  const double share = bridged.share.value_or(decided);
  stylus_of(contact).share = share;
  posed.force *= share;
  work_ += stylus_of(contact).ledger.show(steps_ + 1, motion.halfway * posed.force);
  limited_ += share < 1.0 ? 1 : 0;
}

// The bridge knows best where it pushed: the surface here may lack forces that are still under way.
Vector3 StylusContacts::accepted_arm(const Vector3& arm, const Vector3& own) const noexcept {
  return (arm - own).norm() < kFarFromOwn * size_ ? arm : own;
}

void StylusContacts::solve_bridged(ContactProblem& problem) noexcept {
  for (int a = 0; a < count_; ++a) {
    Contact& contact = contacts_[static_cast<std::size_t>(a)];
    if (!contact.bridged) continue;
    const int row = first_ + a;
    ContactConstraint& posed = problem.contact(row);
    Vector3 gap = posed.gap;
    for (int b = 0; b < problem.count(); ++b) {
      if (b != row) gap -= problem.compliance(row, b) * problem.contact(b).force;
    }
    const SingleContact own = solve_single_contact(problem.compliance(row, row), gap, contact.law,
                                                   posed.normal, posed.friction);
    contact.lets_go = own.mode == ContactMode::kOpen;
    posed.law = contact.law;
    posed.slip = own.slip;
    posed.mode = contact.lets_go ? ContactMode::kSticking : own.mode;
  }
}

void StylusContacts::write(const ContactProblem& problem, ObjectRecord& record) noexcept {
  std::fill_n(record.contact.begin(), styluses_.size(), ContactRecord{});
  for (int a = 0; a < count_; ++a) {
    const ContactConstraint& solved = problem.contact(first_ + a);
    if (solved.mode == ContactMode::kOpen) continue;
    Contact& contact = contacts_[static_cast<std::size_t>(a)];
    const Stylus& stylus = stylus_of(contact);
    ContactRecord& out = record.contact[static_cast<std::size_t>(contact.stylus)];
    out.state = stylus.proxy.state();
    out.slipping = solved.mode == ContactMode::kSlipping;
    out.point = contact.point;
    out.force = solved.force;
    out.normal = solved.normal;
    out.offset = solved.arm - contact.arm;
    out.proxy = contact.arm + solved.elsewhere;
    for (int b = 0; b < count_; ++b) {
      out.proxy += elastic_.block<3, 3>(row(a), row(b)) * problem.contact(first_ + b).force;
    }
    for (int i = 0; i < first_; ++i) {
      out.proxy += problem.elastic(first_ + a, i) * problem.contact(i).force;
    }
    contact.moved = out.proxy - (contact.arm - contact.free);
    // A bridge tells the mean arm itself.
    if (!contact.bridged) {
      contact.arm_shift = stylus.displacement.arm_shift(steps_, contact.free, contact.moved);
    }
    out.arm_shift = contact.arm_shift;
  }
}

void StylusContacts::update(std::span<const StylusCommand> commands, const FreeMotion& motion,
                            const ContactProblem& problem) noexcept {
  const double share = dt_ / kEdgeTime;
  for (int a = 0; a < count_; ++a) {
    const Contact& contact = contacts_[static_cast<std::size_t>(a)];
    GodObject& proxy = stylus_of(contact).proxy;
    const Vector3 tip = motion.to_body(commands[static_cast<std::size_t>(contact.stylus)].tip);
    const ContactConstraint& solved = problem.contact(first_ + a);
    if (solved.mode == ContactMode::kOpen || contact.lets_go) {
      proxy.release(tip);
      continue;
    }
    proxy.stay(solved.slip, share, contact.arm, rest_);
    if (solved.law == ContactLaw::kTouching && !std::isinf(solved.friction.kinetic)) {
      proxy.follow(tip, share, rest_);
    }
    const bool ball = stylus_of(contact).tip.has_ball();  // its own contacts push on
    if (proxy.contact().releasing() && pushes(solved) && !proxy.reached() && !ball) {
      proxy.turn_to_touching();
    }
  }
}

void StylusContacts::end_step(const ContactProblem& problem, const Quaternion& halfway,
                              NodalForces& nodal, RigidStateHistory::Forces& forces) noexcept {
  const double share = dt_ / kAverageTime;
  for (Stylus& stylus : styluses_) stylus.last.average *= 1.0 - share;
  for (int a = 0; a < count_; ++a) {
    const ContactConstraint& solved = problem.contact(first_ + a);
    if (solved.mode == ContactMode::kOpen) continue;
    const Contact& contact = contacts_[static_cast<std::size_t>(a)];
    nodal.add(patch(a), solved.force);
    Stylus& stylus = stylus_of(contact);
    if (!contact.bridged) work_ += (halfway * solved.force).dot(stylus.way);
    LastContact& last = stylus.last;
    stylus.displacement.remember(steps_, contact.moved);
    if (!last.any || last.last_step + 1 != steps_) last.first_step = steps_;
    last.last_step = steps_;
    last.any = true;
    last.point = contact.point;
    last.arm = contact.arm;
    last.average += share * solved.force;
    forces.add(halfway * solved.force, solved.arm + contact.arm_shift);
  }
  delayed_ = false;
  ++steps_;
}

bool StylusContacts::may_touch(std::size_t s) const noexcept {
  return state(s) != ContactState::kFree || styluses_[s].proxy.outside();
}

bool StylusContacts::locate(std::size_t s, const Vector3& tip, ContactModel& model,
                            ContactPatch& patch, int& budget) noexcept {
  Stylus& stylus = styluses_[s];
  model.state = stylus.proxy.state();
  model.slipping = stylus.proxy.contact().slipping();
  SurfacePoint point = stylus.proxy.point();
  if (model.state == ContactState::kFree) {
    Prediction& prediction = stylus.prediction;
    if (!prediction.under_way || steps_ > prediction.step + kPredictedFor) {
      if (budget-- <= 0) return false;
      begin_prediction(stylus, surface_.closest(tip).point);
      prediction.under_way = true;
    }
    point = prediction.point;
    patch = prediction.patch;
  } else {
    stylus.mask.spread(point, patch);
  }
  const SmoothedSurface::Place place = place_of(stylus, model.state, point);
  if (model.state != ContactState::kHeld) model.normal = place.normal;
  model.place = place.position;
  return true;
}

void StylusContacts::end_prediction(std::size_t s, const ContactPatch& patch) noexcept {
  Prediction& prediction = styluses_[s].prediction;
  prediction.patch = patch;
  prediction.step = steps_;
  prediction.under_way = false;
}

void StylusContacts::begin_prediction(Stylus& stylus, const SurfacePoint& point) noexcept {
  stylus.mask.spread(point, stylus.prediction.patch);
  stylus.prediction.point = point;
  stylus.prediction.step = steps_;
}

// Of a contact, or of where one would begin: what comes to the tip, object at rest. What is held
// has no normal.
SmoothedSurface::Place StylusContacts::place_of(Stylus& stylus, ContactState state,
                                                const SurfacePoint& point) noexcept {
  if (state != ContactState::kHeld) return stylus.felt.at(point);
  ContactPatch patch;
  stylus.mask.spread(point, patch);
  return {stylus.proxy.offset() + mean(patch, [&](int i) { return rest_.node(i); }), {}};
}

bool StylusContacts::write_series(std::size_t s, const RigidMobility& mobility,
                                  ContactModel& model) noexcept {
  const Stylus& stylus = styluses_[s];
  model.series.setZero();
  const double stiffness = stylus.tip.coupling_stiffness;
  if (stiffness > 0) model.series.diagonal().array() += 1.0 / stiffness;
  if (!stylus.proxy.contact().releasing()) return true;
  const double left = stylus.proxy.contact().hold_left(dt_, release_time_, 1);
  if (left <= 0) return false;
  const Vector3 arm = model.place + model.path[0];
  model.series +=
      release_compliance(left, model.response[0] + mobility.between(arm, arm) + model.series);
  return true;
}

void StylusContacts::add_others(std::size_t s, const ContactProblem& problem, NodalForces& nodal,
                                ContactModel& model) const noexcept {
  for (int a = 0; first_ + a < problem.count(); ++a) {
    const ContactConstraint& solved = problem.contact(first_ + a);
    const int stylus = contacts_[static_cast<std::size_t>(a)].stylus;
    if (solved.mode == ContactMode::kOpen || stylus == static_cast<int>(s)) continue;
    const Vector3& force = styluses_[static_cast<std::size_t>(stylus)].last.average;
    nodal.add(patch(a), force);
    model.other_force += force;
    model.other_torque += solved.arm.cross(force);
  }
}

// Of those that go on the one that exerts most: more of them would cost more than a step has.
std::optional<std::size_t> StylusContacts::strongest_other(
    std::size_t s, const ContactProblem& problem) const noexcept {
  std::optional<std::size_t> strongest;
  for (int a = 0; first_ + a < problem.count(); ++a) {
    const auto other = static_cast<std::size_t>(contacts_[static_cast<std::size_t>(a)].stylus);
    const Stylus& stylus = styluses_[other];
    const PersistentContact& contact = stylus.proxy.contact();
    const bool goes_on = problem.contact(first_ + a).mode != ContactMode::kOpen && contact.any() &&
                         !contact.releasing() && stylus.position.has_value();
    if (other == s || !goes_on) continue;
    const double force = stylus.last.average.squaredNorm();
    if (!strongest || force > styluses_[*strongest].last.average.squaredNorm()) strongest = other;
  }
  return strongest;
}

bool StylusContacts::find_other(std::size_t s, const Friction& friction,
                                const ContactProblem& problem,
                                AssemblyHorizon::Contact& found) noexcept {
  const std::optional<std::size_t> other = strongest_other(s, problem);
  if (!other) return false;
  Stylus& stylus = styluses_[*other];
  const PersistentContact& contact = stylus.proxy.contact();
  Prediction& prediction = stylus.prediction;
  if (prediction.patch.count == 0 || steps_ > prediction.step + kPredictedFor) {
    begin_prediction(stylus, stylus.proxy.point());
    prediction.under_way = false;
  }
  found.patch = prediction.patch;
  const bool touches = contact.state() == ContactState::kTouching;
  found.law = touches ? ContactLaw::kTouching : ContactLaw::kHeld;
  found.friction = friction;
  if (contact.slipping()) found.friction.static_ = friction.kinetic;
  const SmoothedSurface::Place place = place_of(stylus, contact.state(), stylus.proxy.point());
  if (touches) found.normal = place.normal;
  found.place = place.position;
  found.tip = *stylus.position;
  found.velocity = stylus.velocity;
  found.force = stylus.last.average;
  found.series = stylus.tip.coupling_stiffness > 0 ? 1.0 / stylus.tip.coupling_stiffness : 0.0;
  return true;
}

bool StylusContacts::locate_delayed(std::size_t s, const Vector3& tip, const Vector3& arm,
                                    LateForce& entry) noexcept {
  Stylus& stylus = styluses_[s];
  const LastContact& last = stylus.last;
  const std::uint64_t step = steps_ - 1 - static_cast<std::uint64_t>(entry.age);
  Vector3 own = last.arm;
  if (last.any && last.first_step <= step && step <= last.last_step) {
    entry.point = last.point;
  } else {
    const SurfaceHit hit = surface_.closest(tip);
    if (std::abs(hit.signed_distance) > kNearDelayed) return false;
    entry.point = hit.point;
    ContactPatch patch;
    stylus.mask.spread(entry.point, patch);
    own = mean(patch, [&](int i) { return rest_.node(i); });
  }
  entry.arm = accepted_arm(arm, own);
  return true;
}

void StylusContacts::tell_late(std::size_t s, const Vector3& tip, int age) noexcept {
  late_work_ += styluses_[s].ledger.tell(told_step(age), tip);
}

double StylusContacts::unsettled_work(std::size_t s, const Vector3& force, int age) const noexcept {
  return late_work_ + styluses_[s].ledger.of(told_step(age), force);
}

void StylusContacts::add_delayed(std::size_t s, const Vector3& force, int age) noexcept {
  late_work_ += styluses_[s].ledger.show(told_step(age), force);
  delayed_ = true;
}

void StylusContacts::spread(std::size_t s, const SurfacePoint& point, const Vector3& force,
                            NodalForces& nodal) noexcept {
  ContactPatch patch;
  styluses_[s].mask.spread(point, patch);
  nodal.add(patch, force);
}

}  // namespace irdm
