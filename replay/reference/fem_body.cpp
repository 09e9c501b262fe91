#include "replay/reference/fem_body.hpp"

#include <algorithm>
#include <cmath>

#include "common/error.hpp"
#include "precompute/fem/mass_properties.hpp"
#include "simulation/step/object_sampling.hpp"
#include "simulation/step/stylus_patch.hpp"

namespace irdm::replay {
namespace {

// How far a point may miss its tip, as an acceleration: over a step's length squared [m/s^2]. The
// force that a miss costs grows so with shorter steps.
constexpr double kMiss = 2.5e-4;
constexpr double kTrialForce = 1e-3;  // [N]

}  // namespace

// While the hold is given up, and where a tip merely touches, the recorded force acts.
bool FemBody::follows(const ContactRecord& contact, const StylusRecord& stylus) const {
  return follow_tips_ && contact.state == ContactState::kHeld && stylus.present &&
         (stylus.buttons & kGrabButton) != 0;
}

void FemBody::choose_followed(const ObjectRecord& recorded,
                              std::span<const StylusRecord> styluses) {
  const std::vector<Followed> before = std::move(followed_);
  followed_.clear();
  for (std::size_t s = 0; s < styluses.size(); ++s) {
    if (!follows(recorded.contact[s], styluses[s])) continue;
    Followed& followed =
        followed_.emplace_back(Followed{s, styluses[s].tip, spring_compliance_[s], {}});
    masks_[s].spread(recorded.contact[s].point, followed.patch);
  }
  const bool same =
      std::equal(before.begin(), before.end(), followed_.begin(), followed_.end(),
                 [](const Followed& a, const Followed& b) { return a.stylus == b.stylus; });
  if (same) return;
  tip_forces_.forget();
  last_forces_.clear();
}

// Where each tip is away from where its point and its coupling spring take it [m], W.
Eigen::VectorXd FemBody::misses(const ObjectRecord& moved) const {
  const Quaternion Q(rigid_motion().rotation);
  Eigen::VectorXd misses(3 * static_cast<Eigen::Index>(followed_.size()));
  for (std::size_t i = 0; i < followed_.size(); ++i) {
    const Followed& followed = followed_[i];
    const ContactRecord& contact = moved.contact[followed.stylus];
    const Vector3 force = moved.halfway * contact.force;
    misses.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        followed.tip - place(followed.patch) - Q * contact.offset - followed.compliance * force;
  }
  return misses;
}

// The forces, constant during the step as the server's, that take the points to their tips by its
// end; in the record they stand in B as the recorded ones do.
void FemBody::follow(ObjectRecord& recorded) {
  const precompute::BodyState before = state_;
  const double largest_speed = workspace_.largest_speed;
  const auto missed = [&](const Eigen::VectorXd& forces) {
    put_forces(forces, recorded);
    state_ = before;
    workspace_.largest_speed = largest_speed;
    move(recorded);
    return misses(recorded);
  };
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(followed_.size()));
  if (!last_forces_.empty()) forces = last_forces_[0];
  if (last_forces_.size() > 1) forces += last_forces_[0] - last_forces_[1];
  if (!tip_forces_.solve(missed, forces, kMiss * model_->dt * model_->dt, kTrialForce)) {
    throw Error("--reference fem", "a held point cannot follow its tip",
                "use smaller sub-steps, or --from forces");
  }
  remember_forces(forces);
}

void FemBody::put_forces(const Eigen::VectorXd& forces, ObjectRecord& recorded) const {
  for (std::size_t i = 0; i < followed_.size(); ++i) {
    recorded.contact[followed_[i].stylus].force =
        recorded.halfway.conjugate() * Vector3(forces.segment<3>(3 * static_cast<Eigen::Index>(i)));
  }
}

void FemBody::remember_forces(const Eigen::VectorXd& forces) {
  last_forces_.insert(last_forces_.begin(), forces);
  if (last_forces_.size() > 2) last_forces_.pop_back();
}

namespace {

using precompute::as_points;

// Of the speed, for a step of the rule: far below what its length costs.
constexpr double kTolerance = 1e-9;
// Where that takes more than this, two steps of half the length take less.
constexpr int kMostIterations = 25;
constexpr int kMostHalvings = 6;

// Both alpha and beta: every mode's decay rate is then so many times what it was.
Material damped(Material material, double factor) {
  material.rayleigh_alpha *= factor;
  material.rayleigh_beta *= factor;
  return material;
}

// dv/dt = a - rate v moves v by this times its value at the start.
double decayed(double rate, double time) {
  return rate > 0.0 ? -std::expm1(-rate * time) / rate : time;
}

}  // namespace

// Rounding must not make one more.
int fem_parts(double dt, double longest) {
  return std::max(1, static_cast<int>(std::ceil(dt / longest - 1e-9)));
}

FemBody::Mesh::Mesh(const Model& model, precompute::Elasticity elasticity, double damping, double h)
    : body({model.mesh.nodes, model.mesh.tets, {}}, damped(model.material, damping), elasticity),
      rule(body, kTolerance, kMostIterations) {
  rule.prepare(h);
}

FemBody::FemBody(const SimulationConfig& config, std::size_t number,
                 precompute::Elasticity elasticity, double substep, bool follow_tips,
                 std::vector<DelayedForces> delayed_forces)
    : number_(static_cast<int>(number)),
      model_(config.objects[number].model),
      rigid_(model_->body, model_->dt),
      surface_(model_->mesh),
      recorded_forces_(config, number, surface_),
      elasticity_(elasticity),
      follow_tips_(follow_tips),
      delayed_forces_(std::move(delayed_forces)),
      parts_(fem_parts(model_->dt, substep)),
      h_(model_->dt / parts_),
      mesh_(std::make_unique<Mesh>(*model_, elasticity_, 1.0, h_)),
      force_(Eigen::VectorXd::Zero(model_->mesh.nodes.size())) {
  if (touches_bodies(config)) {
    sampling_ = make_sampling(config, *model_, surface_);
  }
  for (const SimulationStylus& stylus : config.styluses) {
    masks_.emplace_back(surface_, patch_radius(stylus, surface_));
    spring_compliance_.push_back(stylus.coupling_stiffness > 0.0 ? 1.0 / stylus.coupling_stiffness
                                                                 : 0.0);
  }
  const SimulationObject& object = config.objects[number];
  start_.position = object.position;
  start_.orientation = object.orientation.normalized();
  start_.velocity = object.velocity;
  start_.angular_momentum = rigid_.angular_momentum(start_.orientation, object.angular_velocity);
  free_forces_ = {config.gravity, object.damping, object.tether, start_.position,
                  start_.orientation};
  reset();
}

void FemBody::reset() {
  const Matrix3 Q = start_.orientation.toRotationMatrix();
  const Vector3 w = rigid_.angular_velocity(start_);
  const Points& X = mesh_->body.rest();
  followed_.clear();
  state_ = mesh_->body.at_rest();
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    const Vector3 arm = Q * X.row(i).transpose();
    state_.u.segment<3>(3 * i) = start_.position + arm - X.row(i).transpose();
    state_.v.segment<3>(3 * i) = start_.velocity + w.cross(arm);
  }
}

void FemBody::set(const Vector3& gravity, const ObjectSettings& settings) {
  free_forces_.gravity = gravity;
  free_forces_.damping = settings.damping;
  free_forces_.tether = settings.tether;
  if (settings.material_damping == material_damping_) return;
  material_damping_ = settings.material_damping;
  mesh_ = std::make_unique<Mesh>(*model_, elasticity_, material_damping_, h_);
  workspace_.solver.reset();
}

precompute::RigidMotion FemBody::rigid_motion() const {
  return precompute::extract_rigid_motion(mesh_->body.rest(), as_points(state_.u),
                                          mesh_->body.mass(), precompute::RotationWeights::kMass);
}

RigidState FemBody::rigid_state() const {
  const precompute::RigidMotion motion = rigid_motion();
  const Vector3 momentum = mesh_->body.momentum(state_.v);
  RigidState state;
  state.position = motion.translation;
  state.orientation = Quaternion(motion.rotation);
  state.velocity = momentum / mesh_->body.mass().sum();
  state.angular_momentum =
      mesh_->body.angular_momentum(state_) - motion.translation.cross(momentum);
  return state;
}

// Of the mesh as it is deformed.
Vector3 FemBody::angular_velocity(const RigidState& state) const {
  const Points x = mesh_->body.rest() + as_points(state_.u);
  return precompute::nodal_mass_properties(x, mesh_->body.mass())
      .inertia.ldlt()
      .solve(state.angular_momentum);
}

// In W.
Vector3 FemBody::place(int node) const {
  const int n = model_->mesh.surface_nodes[static_cast<std::size_t>(node)];
  return mesh_->body.rest().row(n).transpose() + state_.u.segment<3>(3 * n);
}

Vector3 FemBody::place(const ContactPatch& patch) const {
  return mean(patch, [&](int node) { return place(node); });
}

// Of the nodes that have its force.
Vector3 FemBody::place(const TouchForce& touch) const {
  const auto of_patch = [&](const SurfacePatch& patch) {
    return mean(patch, [&](int node) { return place(node); });
  };
  const BodyContactRecord& contact = *touch.contact;
  if (touch.first) return of_patch(sampling_->patch_of(contact.sample));
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    sum += contact.weights[i] * of_patch(sampling_->patch(sampling_->sites(contact.triangle)[i]));
  }
  return sum;
}

// Of components in a body frame that stands so.
void FemBody::add_forces(std::span<const NodalForce> forces, const Quaternion& Q) {
  for (const NodalForce& nodal : forces) {
    const int node = model_->mesh.surface_nodes[static_cast<std::size_t>(nodal.node)];
    force_.segment<3>(3 * node) += Q * nodal.force;
  }
}

void FemBody::hold(const ObjectRecord& recorded) {
  const Quaternion& Q = recorded.halfway;
  force_.setZero();
  couples_.clear();
  add_forces(recorded_forces_.of(recorded, body_contacts_), Q);
  for (const ContactRecord& contact : recorded.contact) {
    if (contact.state == ContactState::kFree) continue;
    couples_.push_back({contact.offset, Q * contact.force});
  }
  hold_touches(Q);
  hold_late();
}

// Their couples: other bodies' forces act on the body as a whole where the bodies touch, and not
// quite where the nodes are that they are spread over.
void FemBody::hold_touches(const Quaternion& halfway) {
  if (touches_.empty()) return;
  const RigidState state = rigid_state();
  for (const TouchForce& touch : touches_) {
    const Vector3 arm = state.orientation.conjugate() * (place(touch) - state.position);
    couples_.push_back({halfway.conjugate() * touch.arm - arm, touch.force});
  }
}

// What was told late and belongs to this step, unless it is found here anew.
void FemBody::hold_late() {
  for (const DelayedForces& told : delayed_forces_) {
    if (told.step != steps_) continue;
    const auto own = [&](const Followed& f) {
      return static_cast<int>(f.stylus) == told.late.stylus;
    };
    if (std::any_of(followed_.begin(), followed_.end(), own)) continue;
    add_forces(recorded_forces_.of(told.late), told.orientation);
    ContactPatch patch;
    masks_[static_cast<std::size_t>(told.late.stylus)].spread(told.late.point, patch);
    const RigidState state = rigid_state();
    const Vector3 arm = state.orientation.conjugate() * (place(patch) - state.position);
    couples_.push_back({told.late.arm - arm, told.orientation * told.late.force});
  }
}

bool FemBody::kicks() const {
  return !couples_.empty() || !free_forces_.gravity.isZero(0.0) ||
         !(free_forces_.damping == RigidDamping{}) || !(free_forces_.tether == Tether{});
}

void FemBody::kick(double time) {
  if (!kicks()) return;
  const RigidState state = rigid_state();
  const RigidDamping& damping = free_forces_.damping;
  const Vector3 force = free_force(rigid_.mass(), free_forces_, state.position) -
                        rigid_.mass() * damping.linear * state.velocity;
  Vector3 torque =
      free_torque(free_forces_, state.orientation) - damping.angular * state.angular_momentum;
  for (const OffsetForce& couple : couples_) {
    torque += (state.orientation * couple.offset).cross(couple.force);
  }
  const Points x = mesh_->body.rest() + as_points(state_.u);
  const Vector3 turning =
      precompute::nodal_mass_properties(x, mesh_->body.mass()).inertia.ldlt().solve(torque);
  const Vector3 more = decayed(damping.linear, time) * force / rigid_.mass();
  const Vector3 more_spin = decayed(damping.angular, time) * turning;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Vector3 arm = x.row(i).transpose() - state.position;
    state_.v.segment<3>(3 * i) += more + more_spin.cross(arm);
  }
}

void FemBody::advance(double h, int halvings) {
  const precompute::BodyState before = state_;
  const double largest_speed = workspace_.largest_speed;
  try {
    mesh_->rule.step(state_, force_, h, workspace_);
  } catch (const Error&) {
    if (halvings == 0) throw;
    state_ = before;
    workspace_.largest_speed = largest_speed;
    mesh_->rule.prepare(0.5 * h);
    advance(0.5 * h, halvings - 1);
    advance(0.5 * h, halvings - 1);
  }
}

// Under the forces of the record.
void FemBody::move(const ObjectRecord& recorded) {
  hold(recorded);
  for (int part = 0; part < parts_; ++part) {
    kick(0.5 * h_);
    advance(h_, kMostHalvings);
    kick(0.5 * h_);
  }
}

void FemBody::solve(ObjectRecord& recorded) {
  if (followed_.empty()) {
    move(recorded);
  } else {
    follow(recorded);
  }
}

// Number of the step, and what the next one depends on: largest speed, u, v, and the forces of
// followed points.
bool FemBody::take_from_journal(ObjectRecord& recorded) {
  if (journal_ == nullptr || !journal_->take(numbers_)) return false;
  const Eigen::Index n = state_.u.size();
  const auto forces = 3 * static_cast<Eigen::Index>(followed_.size());
  const Eigen::Map<const Eigen::VectorXd> all(numbers_.data(),
                                              static_cast<Eigen::Index>(numbers_.size()));
  if (all.size() != 2 + 2 * n + forces || all[0] != static_cast<double>(steps_)) {
    throw Error("work file", "has steps of another run",
                "remove FILE.steps beside the output, and let one run at a time write there");
  }
  workspace_.largest_speed = all[1];
  state_.u = all.segment(2, n);
  state_.v = all.segment(2 + n, n);
  if (followed_.empty()) return true;
  put_forces(all.tail(forces), recorded);
  remember_forces(all.tail(forces));
  return true;
}

void FemBody::keep_in_journal() {
  if (journal_ == nullptr) return;
  numbers_ = {static_cast<double>(steps_), workspace_.largest_speed};
  numbers_.insert(numbers_.end(), state_.u.begin(), state_.u.end());
  numbers_.insert(numbers_.end(), state_.v.begin(), state_.v.end());
  if (!followed_.empty()) {
    numbers_.insert(numbers_.end(), last_forces_[0].begin(), last_forces_[0].end());
  }
  journal_->keep(numbers_);
}

void FemBody::step(ObjectRecord& again, const RecordedStep& recorded) {
  const RigidState start = rigid_state();
  choose_followed(again, recorded.styluses);
  body_contacts_ = recorded.body_contacts;
  find_touch_forces(number_, again, body_contacts_, touches_);
  if (!take_from_journal(again)) {
    solve(again);
    keep_in_journal();
  }
  const Quaternion halfway = rigid_.mid_step_orientation(start);
  const Quaternion turn = halfway.conjugate() * again.halfway;
  for (ContactRecord& contact : again.contact) contact.force = turn * contact.force;
  for (std::size_t i = 0; i < static_cast<std::size_t>(again.floor_count); ++i) {
    again.floor[i].force = turn.cast<float>() * again.floor[i].force;
  }
  ++steps_;
  const RigidState end = rigid_state();
  again.start = start;
  again.halfway = halfway;
  again.spin.setZero();
  again.position = end.position;
  again.orientation = end.orientation;
  again.velocity = end.velocity;
  again.angular_velocity = angular_velocity(end);
}

void FemBody::rest(ObjectRecord& again) {
  state_.v.setZero();
  ++steps_;
  again.start = rigid_state();
  again.position = again.start.position;
  again.halfway = again.orientation = again.start.orientation;
}

void FemBody::displacement(Points& u) const {
  const Points all =
      precompute::elastic_part(mesh_->body.rest(), as_points(state_.u), rigid_motion());
  u = all(model_->mesh.surface_nodes, Eigen::all);
}

}  // namespace irdm::replay
