#include "server/step/simulation.hpp"

#include "server/step/nodal_forces.hpp"

namespace irdm {
namespace {

// First row of contact i in matrices over the contacts.
Eigen::Index row(std::size_t i) {
  return static_cast<Eigen::Index>(3 * i);
}

}  // namespace

Simulation::Simulation(std::shared_ptr<const Model> model, const SimulationConfig& config)
    : model_(std::move(model)),
      config_(config),
      engine_(make_engine(model_)),
      surface_(model_->mesh),
      body_(model_->body, model_->dt) {
  start_.position = config.position;
  start_.orientation = config.orientation.normalized();
  start_.velocity = config.velocity;
  start_.angular_momentum = body_.angular_momentum(start_.orientation, config.angular_velocity);
  state_ = start_;
}

void Simulation::reset() noexcept {
  state_ = start_;
  engine_->reset();
  styluses_.fill(Stylus{});
}

void Simulation::step(std::span<const StylusCommand> commands, StepRecord& record) noexcept {
  record.force_step = next_step_++;
  record.time = static_cast<double>(next_step_) * model_->dt;
  surface_.begin_step(*engine_);
  const FreeMotion motion = predict_free_motion();
  collect(motion, commands);
  solve(motion, commands, record);
  settle();
  const Quaternion orientation = state_.orientation;
  advance();
  write(commands, orientation, record);
}

Simulation::FreeMotion Simulation::predict_free_motion() const noexcept {
  const RigidState end = body_.advance(state_, body_.mass() * config_.gravity, Vector3::Zero());
  return {end.position, end.orientation};
}

// A tip that comes through the surface from outside proposes a touching contact at its entry.
void Simulation::find_contact(const FreeMotion& motion, const StylusCommand& command,
                              Stylus& stylus) noexcept {
  const Vector3 tip = motion.to_body(command.tip);
  const SurfaceHit hit = surface_.closest(tip);
  if (hit.signed_distance > 0) {
    stylus.outside = true;
  } else if (stylus.outside) {
    stylus.contact = ContactState::kTouching;
    stylus.triangle = hit.triangle;
    stylus.point = hit.point;
    stylus.offset.setZero();
    const auto entry = surface_.entry(hit.triangle, stylus.last_tip, tip, stylus.triangle);
    if (entry) stylus.point = *entry;
  }
  stylus.last_tip = tip;
}

// Decides which styluses are in contact in this step, and where.
void Simulation::collect(const FreeMotion& motion,
                         std::span<const StylusCommand> commands) noexcept {
  contact_count_ = 0;
  for (int s = 0; s < config_.stylus_count; ++s) {
    const StylusCommand& command = commands[static_cast<std::size_t>(s)];
    Stylus& stylus = styluses_[static_cast<std::size_t>(s)];
    if (!command.present || !command.tip.allFinite()) {
      stylus = Stylus{};
      continue;
    }
    if (command.given) {
      stylus.contact = command.given->contact;
      stylus.point = command.given->point;
    } else if (stylus.contact == ContactState::kFree) {
      find_contact(motion, command, stylus);
    }
    if (stylus.contact == ContactState::kFree) continue;
    if (!command.given) {
      // The touched point sticks to the tip, so holding it needs no offset and makes no jump.
      const bool grab = (command.buttons & kGrabButton) != 0;
      stylus.contact = grab ? ContactState::kHeld : ContactState::kTouching;
    }
    Contact& contact = contacts_[static_cast<std::size_t>(contact_count_)];
    contact = Contact{};
    contact.stylus = s;
    contact.state = stylus.contact;
    contact.given = command.given.has_value();
    points_[static_cast<std::size_t>(contact_count_)] = stylus.point;
    ++contact_count_;
  }
}

// Steps 1 and 3: where the contacts' points would be without force, and the compliance between
// them.
void Simulation::predict_contacts() noexcept {
  const auto count = static_cast<std::size_t>(contact_count_);
  std::array<Vector3, kMaxContacts> h;
  engine_->predict({points_.data(), count}, {h.data(), count}, elastic_);
  for (std::size_t a = 0; a < count; ++a) {
    contacts_[a].arm =
        h[a] + interpolate(points_[a], [&](int i) { return model_->mesh.rest_position(i); });
  }
  total_ = elastic_;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) {
      total_.block<3, 3>(row(a), row(b)) += body_.compliance(contacts_[a].arm, contacts_[b].arm);
    }
  }
}

// Step 2 and the rest of 3: the problem of those contacts whose force is not given. `unknown` names
// them.
ContactProblem Simulation::contact_problem(
    const FreeMotion& motion, std::span<const StylusCommand> commands,
    std::array<std::size_t, kMaxContacts>& unknown) noexcept {
  const auto count = static_cast<std::size_t>(contact_count_);
  ContactProblem problem;
  for (std::size_t a = 0; a < count; ++a) {
    if (!contacts_[a].given) unknown[static_cast<std::size_t>(problem.count++)] = a;
  }
  const auto m = static_cast<std::size_t>(problem.count);
  problem.W.resize(row(m), row(m));
  problem.gap.resize(row(m));
  for (std::size_t i = 0; i < m; ++i) {
    const std::size_t a = unknown[i];
    const Contact& contact = contacts_[a];
    const Stylus& stylus = styluses_[static_cast<std::size_t>(contact.stylus)];
    const Vector3& tip = commands[static_cast<std::size_t>(contact.stylus)].tip;
    Vector3 gap = motion.to_body(tip) - stylus.offset - contact.arm;
    for (std::size_t b = 0; b < count; ++b) {
      if (contacts_[b].given) gap -= total_.block<3, 3>(row(a), row(b)) * contacts_[b].force;
    }
    problem.gap.segment<3>(row(i)) = gap;
    for (std::size_t j = 0; j < m; ++j) {
      problem.W.block<3, 3>(row(i), row(j)) = total_.block<3, 3>(row(a), row(unknown[j]));
    }
    if (config_.coupling_stiffness > 0) {
      problem.W.block<3, 3>(row(i), row(i)).diagonal().array() += 1.0 / config_.coupling_stiffness;
    }
    const bool held = contact.state == ContactState::kHeld;
    problem.law[i] = held ? ContactLaw::kHeld : ContactLaw::kTouching;
    problem.normal[i] = surface_.normal(stylus.triangle);
  }
  return problem;
}

// Step 4: the forces that take the contacts' points to the tips.
void Simulation::solve(const FreeMotion& motion, std::span<const StylusCommand> commands,
                       StepRecord& record) noexcept {
  record.residual = 0.0;
  record.solved = true;
  if (contact_count_ == 0) return;
  predict_contacts();
  for (int a = 0; a < contact_count_; ++a) {
    Contact& contact = contacts_[static_cast<std::size_t>(a)];
    const auto& given = commands[static_cast<std::size_t>(contact.stylus)].given;
    if (given) contact.force = state_.orientation.conjugate() * given->force;
  }
  std::array<std::size_t, kMaxContacts> unknown{};
  const ContactProblem problem = contact_problem(motion, commands, unknown);
  const ContactSolution solution = solve_contacts(problem);
  for (std::size_t i = 0; i < static_cast<std::size_t>(problem.count); ++i) {
    Contact& contact = contacts_[unknown[i]];
    contact.force = solution.force.segment<3>(row(i));
    if (!solution.active[i]) contact.state = ContactState::kFree;
  }
  record.residual = solution.residual;
  record.solved = solution.finite;
}

// A contact that let go leaves its stylus free and outside.
void Simulation::settle() noexcept {
  for (int a = 0; a < contact_count_; ++a) {
    const Contact& contact = contacts_[static_cast<std::size_t>(a)];
    Stylus& stylus = styluses_[static_cast<std::size_t>(contact.stylus)];
    stylus.contact = contact.state;
    stylus.outside = true;
    if (contact.state != ContactState::kFree) stylus.last_tip = contact.arm;
  }
}

// Step 5: the forces enter the history, and the rigid motion goes on.
void Simulation::advance() noexcept {
  NodalForces nodal;
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();
  for (int a = 0; a < contact_count_; ++a) {
    const Contact& contact = contacts_[static_cast<std::size_t>(a)];
    if (contact.state == ContactState::kFree) continue;
    nodal.add(points_[static_cast<std::size_t>(a)], contact.force);
    force += contact.force;
    torque += contact.arm.cross(contact.force);
  }
  engine_->advance(nodal.view());
  const Quaternion Q = state_.orientation;
  state_ = body_.advance(state_, Q * force + body_.mass() * config_.gravity, Q * torque);
}

// Step 6, and what else the step leaves. `orientation`: Q at the start of the step, which turned
// the forces.
void Simulation::write(std::span<const StylusCommand> commands, const Quaternion& orientation,
                       StepRecord& record) const noexcept {
  record.position = state_.position;
  record.orientation = state_.orientation;
  record.velocity = state_.velocity;
  record.angular_velocity = body_.angular_velocity(state_);
  record.stylus_count = config_.stylus_count;
  for (std::size_t s = 0; s < static_cast<std::size_t>(config_.stylus_count); ++s) {
    StylusRecord& stylus = record.stylus[s];
    stylus = StylusRecord{};
    stylus.present = commands[s].present;
    stylus.buttons = commands[s].buttons;
    stylus.tip = stylus.proxy = commands[s].tip;
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(contact_count_); ++a) {
    const Contact& contact = contacts_[a];
    if (contact.state == ContactState::kFree) continue;
    Vector3 end = contact.arm;
    for (std::size_t b = 0; b < static_cast<std::size_t>(contact_count_); ++b) {
      if (contacts_[b].state != ContactState::kFree) {
        end += elastic_.block<3, 3>(row(a), row(b)) * contacts_[b].force;
      }
    }
    StylusRecord& stylus = record.stylus[static_cast<std::size_t>(contact.stylus)];
    stylus.contact = contact.state;
    stylus.point = points_[a];
    stylus.offset = styluses_[static_cast<std::size_t>(contact.stylus)].offset;
    stylus.force_on_object = contact.force;
    stylus.force = -(orientation * contact.force);
    stylus.proxy = state_.position + state_.orientation * end;
  }
}

}  // namespace irdm
