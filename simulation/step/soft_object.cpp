#include "simulation/step/soft_object.hpp"

#include <cmath>

#include "common/contact/single_contact.hpp"
#include "common/error.hpp"
#include "simulation/step/gravity_load.hpp"
#include "simulation/step/inertial_loading.hpp"

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

// From the surface, within which a force that comes from elsewhere acts on it [m].
constexpr double kNear = 0.002;
// How far the surface may be from where the bridge knows it to be, as a share of the object's size.
constexpr double kFarFromOwn = 1.0;
// Over which the force of a stylus is averaged for what the bridges of others predict_horizon [s].
constexpr double kAverageTime = 0.2;
// In which a contact catches up with a tip that has passed an edge [s].
constexpr double kEdgeTime = 0.06;

// Rounds of finding where a contact begins, and when it is found [m].
constexpr int kSettlingRounds = 8;
constexpr double kSettled = 1e-6;

// The iteration goes on in the next step from where it was left, so a few sweeps are enough.
constexpr SolverLimits kFloorLimits{200, 1e-10, 8, 1e-6, 1e-4};

}  // namespace

SoftObject::SoftObject(const SimulationObject& object, const SimulationConfig& config, int number)
    : model_(object.model),
      object_(object),
      config_(config),
      number_(number),
      engine_(make_engine(model_)),
      rest_(model_->mesh),
      surface_(rest_),
      body_(model_->body, model_->dt),
      feels_spin_(irdm::has_inertial_loading(*model_, object.inertial_loading)),
      styluses_(config.styluses.size()),
      last_(config.styluses.size()),
      problem_(kMaxContacts + (config.floor ? kMaxFloorContacts : 0)),
      solver_(problem_.capacity()),
      nodal_(kMaxContacts * kMaxPatchNodes + kMaxFloorContacts) {
  check_inertial_loading(*model_, object.inertial_loading, "object");
  start_.position = object.position;
  start_.orientation = object.orientation.normalized();
  start_.velocity = object.velocity;
  start_.angular_momentum = body_.angular_momentum(start_.orientation, object.angular_velocity);
  state_ = start_;
  free_forces_ = {config.gravity, object.damping, object.tether, start_.position,
                  start_.orientation};
  follow_gravity(*engine_, object_, config.gravity);
  for (const SimulationStylus& stylus : config.styluses) {
    const double largest = PressureMask::largest_radius(rest_);
    if (stylus.radius > largest) {
      throw Error("stylus",
                  "radius " + std::to_string(stylus.radius) +
                      " m is too large for an object whose triangles are this small",
                  "use at most " + std::to_string(largest) + " m or a coarser mesh");
    }
    masks_.emplace_back(rest_, stylus.radius);
    rounded_.emplace_back(rest_, stylus.radius);
  }
  for (int i = 0; i < model_->mesh.surface_node_count(); ++i) {
    size_ = std::max(size_, rest_.node(i).norm());
  }
  if (config.floor && body_.moves()) {
    floor_ = std::make_unique<FloorContacts>(*config.floor, rest_, *engine_);
  }
}

void SoftObject::reset() noexcept {
  state_ = start_;
  past_.clear();
  engine_->reset();
  for (GodObject& stylus : styluses_) stylus.forget();
  for (LastContact& last : last_) {
    last.any = false;
    last.average.setZero();
  }
  if (floor_) floor_->reset();
}

void SoftObject::set(const Vector3& gravity, const ObjectSettings& settings) noexcept {
  object_.friction = settings.friction;
  free_forces_.gravity = gravity;
  free_forces_.damping = settings.damping;
  free_forces_.tether = settings.tether;
  feels_spin_ = irdm::has_inertial_loading(*model_, settings.inertial_loading);
  follow_settings(*engine_, settings, material_damping_);
  follow_gravity(*engine_, object_, gravity);
}

void SoftObject::step(std::span<const StylusCommand> commands, ObjectRecord& record) noexcept {
  state_ = past_.replay(body_, free_forces_, state_);
  record.start = state_;
  spin(record);
  surface_.begin_step(*engine_);
  motion_ = free_motion(body_, free_forces_, state_);
  record.halfway = motion_.halfway;
  prefetch_columns(commands);
  collect(commands);
  floor_count_ = floor_ ? floor_->find(motion_, surface_, displaced()) : 0;
  solve(commands, record);
  write(record);
  write_floor(record);
  update_contacts(commands);
  advance();
  record.position = state_.position;
  record.orientation = state_.orientation;
  record.velocity = state_.velocity;
  record.angular_velocity = body_.angular_velocity(state_);
  for (ContactRecord& contact : record.contact) {
    if (contact.state != ContactState::kFree) {
      contact.proxy = state_.position + state_.orientation * contact.proxy;
    }
  }
}

// The spin that the step begins with, without the torques of the step itself: contacts are solved
// on a surface that their own forces do not yet blow up.
void SoftObject::spin(ObjectRecord& record) noexcept {
  record.spin.setZero();
  if (!feels_spin_) return;
  record.spin = body_.mid_step_spin(state_);
  engine_->set_angular_velocity(record.spin);
}

void SoftObject::prefetch_columns(std::span<const StylusCommand> commands) noexcept {
  std::array<Vector3, kMaxStyluses> tips;
  std::size_t count = 0;
  for (const StylusCommand& command : commands) {
    if (command.present && command.tip.allFinite()) tips[count++] = motion_.to_body(command.tip);
  }
  engine_->prefetch({tips.data(), count});
}

// Decides which styluses are in contact in this step, and where.
void SoftObject::collect(std::span<const StylusCommand> commands) noexcept {
  contact_count_ = 0;
  for (std::size_t s = 0; s < styluses_.size(); ++s) {
    const StylusCommand& command = commands[s];
    GodObject& stylus = styluses_[s];
    if (!command.present || !command.tip.allFinite()) {
      stylus.forget();
      continue;
    }
    if (command.given) {
      if (command.given->object != number_) continue;
      stylus.impose(command.given->contact, command.given->point);
    } else {
      const bool grab = (command.buttons & kGrabButton) != 0;
      stylus.find({motion_.to_body(command.tip), grab, config_.styluses[s].reach}, surface_);
    }
    if (command.bridged) apply_remote_contact(s, command);
    if (stylus.state() == ContactState::kFree) continue;
    if (stylus.fresh() && !project_initial_contact(s, motion_.to_body(command.tip))) {
      stylus.reject_contact();
      continue;
    }
    const auto a = static_cast<std::size_t>(contact_count_++);
    contacts_[a] = {.stylus = static_cast<int>(s),
                    .given = command.given.has_value(),
                    .bridged = command.bridged.has_value()};
    points_[a] = stylus.point();
    masks_[s].spread(points_[a], patches_[a]);
    if (stylus.state() != ContactState::kTouching || command.given) continue;
    const SmoothedSurface::Place place = rounded_[s].at(points_[a]);
    contacts_[a].normal = place.normal;
    stylus.set_inset(place.position - mean(patches_[a], [&](int i) { return rest_.node(i); }));
  }
}

// The bridge has one object in mind. Its contact with that one may be none by now: its force acts
// where the tip is, if that is near enough.
void SoftObject::apply_remote_contact(std::size_t s, const StylusCommand& command) noexcept {
  GodObject& stylus = styluses_[s];
  if (command.bridged->object != number_) {
    if (stylus.state() != ContactState::kFree) stylus.reject_contact();
    return;
  }
  if (stylus.state() != ContactState::kFree || !stylus.outside()) return;
  if (command.bridged->force.isZero(0.0)) return;
  const SurfaceHit hit = surface_.closest(motion_.to_body(command.tip));
  if (std::abs(hit.signed_distance) > stylus.tip_moved() + kNear) return;
  stylus.impose(ContactState::kTouching, hit.triangle, hit.point);
}

// A contact begins where the tip is straight below the surface that it feels: were it drawn aside
// from the start, it would get energy from nowhere. False: it is deeper there than it can have come
// in this step. Such a tip was inside all along, and there is no telling how it got there.
bool SoftObject::project_initial_contact(std::size_t s, const Vector3& tip) noexcept {
  GodObject& stylus = styluses_[s];
  double depth = 0.0;
  for (int round = 0; round < kSettlingRounds; ++round) {
    const SmoothedSurface::Place place = rounded_[s].at(stylus.point());
    const Vector3 moved = interpolate(
        stylus.point(), [&](int i) -> Vector3 { return surface_.node(i) - rest_.node(i); });
    const Vector3 gap = tip - place.position - moved;
    depth = -gap.dot(place.normal);
    const Vector3 aside = gap + depth * place.normal;
    if (aside.norm() < kSettled) break;
    stylus.slide(aside, aside.norm(), rest_);
  }
  return depth <= stylus.tip_moved() + kDeepestStart;
}

// Largest displacement under a stylus by the end of the last step [m].
double SoftObject::displaced() const noexcept {
  double largest = 0.0;
  for (const LastContact& last : last_) {
    if (last.any && last.last_step + 1 == steps_)
      largest = std::max(largest, last.displaced.norm());
  }
  return largest;
}

// Steps 1 and 3: where the contacts' points would be without force, and the elastic compliance
// between them.
void SoftObject::predict_contacts() noexcept {
  const auto count = static_cast<std::size_t>(contact_count_);
  std::array<Vector3, kMaxContacts> h;
  engine_->predict({patches_.data(), count}, {h.data(), count}, elastic_);
  for (std::size_t a = 0; a < count; ++a) {
    contacts_[a].free = h[a];
    contacts_[a].arm = h[a] + mean(patches_[a], [&](int i) { return rest_.node(i); });
  }
}

// Step 2 and the rest of 3.
void SoftObject::assemble_contacts(std::span<const StylusCommand> commands) noexcept {
  problem_.begin(floor_count_ + contact_count_);
  problem_.rigid = body_.mobility();
  if (floor_count_ > 0) pose_floor();
  for (int a = 0; a < contact_count_; ++a) {
    const int row_a = floor_count_ + a;
    const Contact& contact = contacts_[static_cast<std::size_t>(a)];
    const auto s = static_cast<std::size_t>(contact.stylus);
    const GodObject& stylus = styluses_[s];
    ContactConstraint& unknown = problem_.contact(row_a);
    for (int b = 0; b < contact_count_; ++b) {
      problem_.elastic(row_a, floor_count_ + b) = elastic_.block<3, 3>(row(a), row(b));
    }
    unknown.arm = contact.arm;
    if (contact.given) {
      unknown.law = ContactLaw::kGiven;
      unknown.force = motion_.halfway.conjugate() * commands[s].given->force;
      continue;
    }
    unknown.law = stylus.state() == ContactState::kHeld ? ContactLaw::kHeld : ContactLaw::kTouching;
    unknown.normal = contact.normal;
    unknown.friction = object_.friction;
    // What slips goes on slipping until kinetic friction can hold it.
    if (stylus.slipping()) unknown.friction.static_ = unknown.friction.kinetic;
    // The tip pushes where it is, so that what it does is what the object gets.
    unknown.arm = contact.arm + stylus.offset();
    unknown.gap = motion_.to_body(commands[s].tip) - unknown.arm;
    const double stiffness = config_.styluses[s].coupling_stiffness;
    if (stiffness > 0) problem_.elastic(row_a, row_a).diagonal().array() += 1.0 / stiffness;
    if (stylus.releasing()) {
      // What is left of the hold, from 1 to 0: a spring in series that grows softer and softer.
      const double left = 1.0 - stylus.steps_since_release() * model_->dt / config_.release_time;
      if (left > 0) {
        problem_.elastic(row_a, row_a) += (1.0 / left - 1.0) * problem_.compliance(row_a, row_a);
      } else {
        unknown.law = ContactLaw::kReleased;
      }
    }
    if (commands[s].bridged) {
      contacts_[static_cast<std::size_t>(a)].law = unknown.law;
      unknown.law = ContactLaw::kGiven;
      unknown.force = motion_.halfway.conjugate() * commands[s].bridged->force;
      if (!unknown.force.isZero(0.0)) {
        unknown.arm = accepted_arm(commands[s].bridged->arm, unknown.arm);
      }
    }
  }
}

// The bridge knows best where it pushed: the surface here may lack forces that are still under way.
Vector3 SoftObject::accepted_arm(const Vector3& arm, const Vector3& own) const noexcept {
  return (arm - own).norm() < kFarFromOwn * size_ ? arm : own;
}

// The floor's contacts come first; what it has in common with the styluses follows.
void SoftObject::pose_floor() noexcept {
  floor_->pose(motion_, surface_, problem_);
  for (int a = 0; a < contact_count_; ++a) {
    for (int i = 0; i < floor_count_; ++i) {
      const Matrix3 shared = floor_->between(patches_[static_cast<std::size_t>(a)], i);
      problem_.elastic(floor_count_ + a, i) = shared;
      problem_.elastic(i, floor_count_ + a) = shared.transpose();
    }
  }
}

// Step 4: the forces that take the contacts' points to the tips.
void SoftObject::solve(std::span<const StylusCommand> commands, ObjectRecord& record) noexcept {
  record.residual = 0.0;
  record.sweeps = 0;
  record.solved = true;
  problem_.begin(0);
  if (contact_count_ + floor_count_ == 0) return;
  if (contact_count_ > 0) predict_contacts();
  assemble_contacts(commands);
  const ContactSolution solution =
      solver_.solve(problem_, floor_count_ > 0 ? kFloorLimits : SolverLimits{});
  follow_bridged(commands);
  record.residual = solution.residual;
  record.sweeps = solution.sweeps;
  record.solved = solution.solved;
}

// What the contacts of bridges would do by themselves among the others' forces: that is how they
// slip and end.
void SoftObject::follow_bridged(std::span<const StylusCommand> commands) noexcept {
  for (int a = 0; a < contact_count_; ++a) {
    Contact& contact = contacts_[static_cast<std::size_t>(a)];
    const auto s = static_cast<std::size_t>(contact.stylus);
    if (!commands[s].bridged) continue;
    const int row_a = floor_count_ + a;
    ContactConstraint& unknown = problem_.contact(row_a);
    Vector3 gap = unknown.gap;
    for (int b = 0; b < problem_.count(); ++b) {
      if (b != row_a) gap -= problem_.compliance(row_a, b) * problem_.contact(b).force;
    }
    const SingleContact own = solve_single_contact(problem_.compliance(row_a, row_a), gap,
                                                   contact.law, unknown.normal, unknown.friction);
    contact.lets_go = own.mode == ContactMode::kOpen;
    unknown.law = contact.law;
    unknown.slip = own.slip;
    unknown.mode = contact.lets_go ? ContactMode::kSticking : own.mode;
  }
}

// Of a contact whose place is displaced by `moved` at the end of the step; a bridge tells the mean
// arm itself.
Vector3 SoftObject::arm_shift(int a, const Vector3& moved) const noexcept {
  const Contact& contact = contacts_[static_cast<std::size_t>(a)];
  if (contact.bridged) return Vector3::Zero();
  const LastContact& last = last_[static_cast<std::size_t>(contact.stylus)];
  const bool goes_on = last.any && last.last_step + 1 == steps_;
  return 0.5 * ((goes_on ? last.displaced : contact.free) + moved) - contact.free;
}

// The contacts of the step, in B; the proxies are turned to W by the caller.
void SoftObject::write(ObjectRecord& record) noexcept {
  record.contact.fill(ContactRecord{});
  for (int a = 0; a < contact_count_; ++a) {
    const ContactConstraint& solved = problem_.contact(floor_count_ + a);
    if (solved.mode == ContactMode::kOpen) continue;
    Contact& contact = contacts_[static_cast<std::size_t>(a)];
    const GodObject& stylus = styluses_[static_cast<std::size_t>(contact.stylus)];
    ContactRecord& out = record.contact[static_cast<std::size_t>(contact.stylus)];
    out.state = stylus.state();
    out.slipping = solved.mode == ContactMode::kSlipping;
    out.point = points_[static_cast<std::size_t>(a)];
    out.force = solved.force;
    out.normal = solved.normal;
    out.offset = solved.arm - contact.arm;
    out.proxy = contact.arm;
    for (int b = 0; b < contact_count_; ++b) {
      out.proxy += elastic_.block<3, 3>(row(a), row(b)) * problem_.contact(floor_count_ + b).force;
    }
    for (int i = 0; i < floor_count_; ++i) {
      out.proxy += problem_.elastic(floor_count_ + a, i) * problem_.contact(i).force;
    }
    contact.moved = out.proxy - (contact.arm - contact.free);
    contact.arm_shift = out.arm_shift = arm_shift(a, contact.moved);
  }
}

// The floor's forces, rounded to what is recorded; this is what acts.
void SoftObject::write_floor(ObjectRecord& record) noexcept {
  record.floor_count = 0;
  record.floor_force.setZero();
  for (int i = 0; i < floor_count_; ++i) {
    ContactConstraint& solved = problem_.contact(i);
    if (solved.mode == ContactMode::kOpen) continue;
    FloorForce& out = record.floor[static_cast<std::size_t>(record.floor_count++)];
    out = {floor_->node(i), solved.force.cast<float>()};
    solved.force = out.force.cast<double>();
    record.floor_force += motion_.halfway * solved.force;
  }
}

void SoftObject::update_contacts(std::span<const StylusCommand> commands) noexcept {
  for (int a = 0; a < contact_count_; ++a) {
    const Contact& contact = contacts_[static_cast<std::size_t>(a)];
    const auto s = static_cast<std::size_t>(contact.stylus);
    const ContactConstraint& solved = problem_.contact(floor_count_ + a);
    if (solved.mode == ContactMode::kOpen || contact.lets_go) {
      styluses_[s].release(motion_.to_body(commands[s].tip));
    } else {
      styluses_[s].stay(solved.slip, model_->dt / kEdgeTime, contact.arm, rest_);
      if (solved.law == ContactLaw::kTouching && !std::isinf(solved.friction.kinetic)) {
        styluses_[s].follow(motion_.to_body(commands[s].tip), model_->dt / kEdgeTime, rest_);
      }
      if (styluses_[s].releasing() && pushes(solved) && !styluses_[s].reached()) {
        styluses_[s].turn_to_touching();
      }
    }
  }
  if (floor_) floor_->update_contacts(motion_, problem_);
}

// What this step looked at, the next one will look at again.
void SoftObject::cache_nodes() noexcept {
  engine_->cache_nodes(surface_.seen());
  for (int a = 0; a < contact_count_; ++a) {
    const ContactPatch& patch = patches_[static_cast<std::size_t>(a)];
    engine_->cache_nodes(std::span(patch.nodes).first(static_cast<std::size_t>(patch.count)));
  }
}

// Step 5: the forces enter the history, and the rigid motion goes on.
void SoftObject::advance() noexcept {
  const double share = model_->dt / kAverageTime;
  for (LastContact& last : last_) last.average *= 1.0 - share;
  nodal_.clear();
  const Quaternion& Q = motion_.halfway;
  RigidStateHistory::Forces forces;
  for (int a = 0; a < contact_count_; ++a) {
    const ContactConstraint& solved = problem_.contact(floor_count_ + a);
    if (solved.mode == ContactMode::kOpen) continue;
    const auto index = static_cast<std::size_t>(a);
    nodal_.add(patches_[index], solved.force);
    LastContact& last = last_[static_cast<std::size_t>(contacts_[index].stylus)];
    if (!last.any || last.last_step + 1 != steps_) last.first_step = steps_;
    last.last_step = steps_;
    last.any = true;
    last.point = points_[index];
    last.patch = patches_[index];
    last.arm = contacts_[index].arm;
    last.displaced = contacts_[index].moved;
    last.average += share * solved.force;
    forces.add(Q * solved.force, solved.arm + contacts_[index].arm_shift);
  }
  for (int i = 0; i < floor_count_; ++i) {
    const ContactConstraint& solved = problem_.contact(i);
    if (solved.mode == ContactMode::kOpen) continue;
    nodal_.add(floor_->node(i), solved.force);
    forces.add(Q * solved.force, solved.arm);
  }
  cache_nodes();
  engine_->advance(nodal_.view());
  past_.remember(state_, Q, forces);
  state_ = end_of_step(body_, free_forces_, motion_, forces.sum, forces.torque(Q));
  ++steps_;
}

}  // namespace irdm
