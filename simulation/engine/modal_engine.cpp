#include "simulation/engine/modal_engine.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "common/response/modal_response.hpp"
#include "simulation/engine/kernels.hpp"
#include "simulation/state/state_archive.hpp"

namespace irdm {
namespace {

constexpr std::size_t kBlock = 16;  // rows of Phi that a thread takes at a time
constexpr std::size_t kMostHeld = kMaxContacts * kMaxPatchNodes;
constexpr std::size_t kSlice = 512;  // modes whose forces fill a part of the cache

void add_to(double* sum, const double* numbers, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) sum[i] += numbers[i];
}

}  // namespace

template <typename Scalar>
ModalEngine<Scalar>::ModalEngine(std::shared_ptr<const Model> model)
    : model_(std::move(model)),
      shapes_(&std::get<RowMatrix<Scalar>>(std::get<ModalResponse>(model_->response).shapes)),
      contact_shapes_(*shapes_),
      horizon_(static_cast<std::size_t>(std::get<ModalResponse>(model_->response).mode_count())),
      residual_(std::get<ModalResponse>(model_->response).residual,
                model_->mesh.surface_node_count()),
      gravity_(std::get<ModalResponse>(model_->response)) {
  const auto& response = std::get<ModalResponse>(model_->response);
  const Eigen::VectorXd largest =
      shapes_->cwiseAbs().colwise().maxCoeff().transpose().template cast<double>();
  largest_shape_.assign(largest.data(), largest.data() + largest.size());
  if (response.centrifugal.rows() > 0) centrifugal_ = response.centrifugal.data();
  modes_ = static_cast<std::size_t>(response.mode_count());
  for (auto* values :
       {&a11_, &a12_, &a21_, &a22_, &b1_, &b2_, &coordinate_, &velocity_, &free_coordinate_,
        &free_velocity_, &modal_force_, &held_force_, &inertial_load_}) {
    values->assign(modes_, 0.0);
  }
  held_.reserve(kMostHeld);
  coordinate_after_.assign(kMaxHorizon * modes_, 0.0);
  velocity_after_.assign(kMaxHorizon * modes_, 0.0);
  set_transitions(1.0);
}

template <typename Scalar>
void ModalEngine<Scalar>::set_transitions(double damping) noexcept {
  const auto& response = *std::get_if<ModalResponse>(&model_->response);
  for (std::size_t i = 0; i < modes_; ++i) {
    const auto index = static_cast<Eigen::Index>(i);
    const HeldForceOscillator step = held_force_oscillator(
        response.angular_frequency(index), damping * response.decay_rate(index), model_->dt);
    a11_[i] = step.a11;
    a12_[i] = step.a12;
    a21_[i] = step.a21;
    a22_[i] = step.a22;
    b1_[i] = step.b1;
    b2_[i] = step.b2;
  }
  horizon_.set_transitions({a11_.data(), a12_.data(), a21_.data(), a22_.data()}, b1_.data(),
                           b2_.data(), response.angular_frequency.data());
  contact_shapes_.forget();
  tabulate_delayed();
}

template <typename Scalar>
void ModalEngine<Scalar>::tabulate_delayed() noexcept {
  const Transitions A{a11_.data(), a12_.data(), a21_.data(), a22_.data()};
  const auto after = [&](std::size_t n) { return coordinate_after_.data() + n * modes_; };
  const auto speed_after = [&](std::size_t n) { return velocity_after_.data() + n * modes_; };
  std::copy_n(b1_.data(), modes_, after(0));
  std::copy_n(b2_.data(), modes_, speed_after(0));
  for (std::size_t n = 0; n + 1 < kMaxHorizon; ++n) {
    transit(A, after(n), speed_after(n), after(n + 1), speed_after(n + 1), modes_);
  }
}

// Where a mode is and how fast it moves stays as it is; only how it goes on changes.
template <typename Scalar>
void ModalEngine<Scalar>::scale_damping(double factor) noexcept {
  set_transitions(factor);
  go_on();
}

template <typename Scalar>
void ModalEngine<Scalar>::move_on() noexcept {
  transit({a11_.data(), a12_.data(), a21_.data(), a22_.data()}, coordinate_.data(),
          velocity_.data(), free_coordinate_.data(), free_velocity_.data(), modes_);
  add_gravity();
}

// Held in the coming step, as in any.
template <typename Scalar>
void ModalEngine<Scalar>::add_gravity() noexcept {
  if (!gravity_.acts()) return;
  const double* const force = gravity_.force().data();
  for (std::size_t i = 0; i < modes_; ++i) {
    free_coordinate_[i] += b1_[i] * force[i];
    free_velocity_[i] += b2_[i] * force[i];
  }
}

template <typename Scalar>
void ModalEngine<Scalar>::set_gravity(const Vector3& gravity) noexcept {
  if (gravity_.set(gravity)) go_on();
}

// Otherwise than by a step; what loaded the body is gone with it.
template <typename Scalar>
void ModalEngine<Scalar>::change_state() noexcept {
  state_ = (state_ | 1) + 3;
  loaded_ = false;
}

// What was changed before the first step was so since ever.
template <typename Scalar>
void ModalEngine<Scalar>::go_on() noexcept {
  change_state();
  if (begun_) {
    move_on();
  } else {
    settle();
  }
}

// At rest under gravity, which stays so.
template <typename Scalar>
void ModalEngine<Scalar>::settle() noexcept {
  gravity_.end_step();
  for (auto* values : {&coordinate_, &velocity_, &free_coordinate_, &free_velocity_}) {
    std::fill(values->begin(), values->end(), 0.0);
  }
  if (!gravity_.acts()) return;
  gravity_.settle(coordinate_);
  gravity_.settle(free_coordinate_);
}

template <typename Scalar>
void ModalEngine<Scalar>::set_angular_velocity(const Vector3& w) noexcept {
  if (centrifugal_ == nullptr) return;
  const SpinProducts q = spin_products(w);
  loaded_ = true;
  state_ |= 1;
  for (std::size_t i = 0; i < modes_; ++i) {
    const double force = Eigen::Map<const SpinProducts>(centrifugal_ + i * kSpinProducts).dot(q);
    inertial_load_[i] = force;
    free_coordinate_[i] += b1_[i] * force;
    free_velocity_[i] += b2_[i] * force;
  }
}

template <typename Scalar>
Vector3 ModalEngine<Scalar>::free_displacement(int node) const noexcept {
  Vector3 u = Vector3::Zero();
  add_products({shape_row(3 * node), modes_, 3}, free_coordinate_.data(), modes_, 1.0, u.data());
  if (gravity_.adds_rest()) u += gravity_.rest(node);
  return u;
}

// |sum_i q_i Phi_ai| is at most the sum of |q_i| max_a |Phi_ai|.
template <typename Scalar>
double ModalEngine<Scalar>::free_displacement_bound() const noexcept {
  return dot_magnitudes(free_coordinate_.data(), largest_shape_.data(), modes_) +
         gravity_.rest_bound();
}

// Before the step's forces moved it, the coordinate at its end was what had been foreseen.
template <typename Scalar>
double ModalEngine<Scalar>::free_change_bound() const noexcept {
  if (was_loaded_) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  std::array<double, kSlice> change;
  for (std::size_t first = 0; first < modes_; first += kSlice) {
    const std::size_t count = std::min(kSlice, modes_ - first);
    for (std::size_t j = 0; j < count; ++j) {
      const std::size_t i = first + j;
      change[j] = free_coordinate_[i] - coordinate_[i];
      if (forced_) change[j] += b1_[i] * modal_force_[i];
    }
    sum += dot_magnitudes(change.data(), &largest_shape_[first], count);
  }
  return sum;
}

template <typename Scalar>
void ModalEngine<Scalar>::predict(std::span<const ContactPatch> patches, std::span<Vector3> h,
                                  ContactMatrix& compliance) noexcept {
  contact_shapes_.predict(patches, {b1_.data(), free_coordinate_.data()}, h, compliance);
  residual_.add_compliance(patches, compliance);
  for (std::size_t a = 0; gravity_.adds_rest() && a < patches.size(); ++a) {
    h[a] += mean(patches[a], [&](int node) { return gravity_.rest(node); });
  }
  compliance.template triangularView<Eigen::StrictlyUpper>() = compliance.transpose();
}

// Three nodes at a time; where fewer are left, the last one counts with weight 0.
template <typename Scalar>
void ModalEngine<Scalar>::collect_modal_forces(std::span<const NodalForce> forces,
                                               const ModeRange& modes,
                                               double* modal) const noexcept {
  double* const to = modal + modes.first;
  std::fill_n(to, modes.count, 0.0);
  for (std::size_t first = 0; first < forces.size(); first += 3) {
    std::array<double, 9> weights{};
    std::array<const Scalar*, 9> rows{};
    for (std::size_t k = 0; k < 9; ++k) {
      const std::size_t at = first + k / 3;
      const NodalForce& nodal = forces[std::min(at, forces.size() - 1)];
      const auto axis = static_cast<int>(k % 3);
      if (at < forces.size()) weights[k] = nodal.force[axis];
      rows[k] = shape_row(3 * nodal.node + axis) + modes.first;
    }
    accumulate_nine(weights, rows, to, modes.count);
  }
}

// Of a patch, with its shapes.
template <typename Scalar>
ModalHorizon::Contact& ModalEngine<Scalar>::horizon_contact(const ContactPatch& patch) noexcept {
  ModalHorizon::Contact* contact = horizon_.find(patch);
  if (contact == nullptr) {
    contact = &horizon_.begin(patch);
    for (std::size_t i = 0; i < 3; ++i) {
      contact_shapes_.mean_shape(patch, static_cast<int>(i), {0, modes_},
                                 &contact->shapes[i * horizon_.stride()]);
    }
  }
  contact->used = state_;
  return *contact;
}

template <typename Scalar>
void ModalEngine<Scalar>::cross_response(const ContactPatch& to, const ContactPatch& from,
                                         std::span<Matrix3> response) noexcept {
  const ModalHorizon::Contact& one = horizon_contact(to);
  horizon_.cross_response(one, horizon_contact(from), response);
  if (!response.empty()) response[0] += residual_.compliance(to, from);
}

template <typename Scalar>
void ModalEngine<Scalar>::predict_horizon(const ContactPatch& patch,
                                          std::span<const NodalForce> held, std::span<Vector3> path,
                                          std::span<Matrix3> response) noexcept {
  ModalHorizon::Contact& contact = horizon_contact(patch);
  const ModalHorizon::State state{.number = state_,
                                  .coordinate = free_coordinate_.data(),
                                  .velocity = free_velocity_.data(),
                                  .force = gravity_.acts() ? gravity_.force().data() : nullptr,
                                  .last = forced_ ? modal_force_.data() : nullptr,
                                  .only = only_,
                                  .only_force = only_force_};
  if (held.empty()) {
    horizon_.update(contact, state, path.size());
    std::copy_n(contact.path.begin(), path.size(), path.begin());
  } else {
    if (contact.steps != path.size()) horizon_.find_response(contact, path.size());
    hold(held);
    horizon_.find_path(contact, state, held_force_.data(), path);
  }
  std::copy_n(contact.response.begin(), response.size(), response.begin());
  Vector3 at_once = residual_.displacement(patch, held);
  if (gravity_.adds_rest()) {
    at_once += mean(patch, [&](int node) { return gravity_.rest(node); });
  }
  for (Vector3& place : path) place += at_once;
  if (!response.empty()) response[0] += residual_.compliance(patch);
}

// Makes held_force_ that of these forces, which several contacts may share.
template <typename Scalar>
void ModalEngine<Scalar>::hold(std::span<const NodalForce> forces) noexcept {
  const bool same = std::equal(forces.begin(), forces.end(), held_.begin(), held_.end(),
                               [](const NodalForce& a, const NodalForce& b) {
                                 return a.node == b.node && a.force == b.force;
                               });
  if (same) return;
  held_.clear();
  if (forces.size() <= held_.capacity()) held_.assign(forces.begin(), forces.end());
  collect_modal_forces(forces, {0, modes_}, held_force_.data());
}

template <typename Scalar>
void ModalEngine<Scalar>::add_delayed_force(std::span<const NodalForce> forces, int age) noexcept {
  if (age < 0 || age >= kMaxHorizon) return;
  if (age == 0) residual_.hold_more(forces);
  begun_ = true;
  change_state();
  collect_modal_forces(forces, {0, modes_}, modal_force_.data());
  const double* coordinate = coordinate_after_.data() + static_cast<std::size_t>(age) * modes_;
  const double* velocity = velocity_after_.data() + static_cast<std::size_t>(age) * modes_;
  for (std::size_t i = 0; i < modes_; ++i) {
    coordinate_[i] += coordinate[i] * modal_force_[i];
    velocity_[i] += velocity[i] * modal_force_[i];
  }
  move_on();
}

// As energy(), without the residual's.
template <typename Scalar>
std::optional<EnergyChange> ModalEngine<Scalar>::energy_change(std::span<const NodalForce> forces,
                                                               int age) noexcept {
  if (age < -1 || age >= kMaxHorizon) return std::nullopt;
  const auto& omega = std::get_if<ModalResponse>(&model_->response)->angular_frequency;
  const double* const coordinate = age < 0 ? free_coordinate_.data() : coordinate_.data();
  const double* const velocity = age < 0 ? free_velocity_.data() : velocity_.data();
  const std::size_t answer = static_cast<std::size_t>(std::max(age, 0)) * modes_;
  collect_modal_forces(forces, {0, modes_}, modal_force_.data());
  EnergyChange change;
  for (std::size_t i = 0; i < modes_; ++i) {
    const double frequency = omega(static_cast<Eigen::Index>(i));
    const double stiffness = frequency * frequency;
    const double q = coordinate_after_[answer + i] * modal_force_[i];
    const double v = velocity_after_[answer + i] * modal_force_[i];
    change.along += velocity[i] * v + stiffness * coordinate[i] * q;
    change.own += 0.5 * (v * v + stiffness * q * q);
  }
  if (gravity_.acts()) {
    for (std::size_t i = 0; i < modes_; ++i) {
      change.along -= gravity_.force()[i] * coordinate_after_[answer + i] * modal_force_[i];
    }
  }
  return change;
}

template <typename Scalar>
void ModalEngine<Scalar>::advance(std::span<const NodalForce> forces) noexcept {
  residual_.hold(forces);
  gravity_.end_step();
  begun_ = true;
  coordinate_.swap(free_coordinate_);
  velocity_.swap(free_velocity_);
  state_ = (state_ | 1) + 1;
  const bool loaded = std::exchange(loaded_, false);
  was_loaded_ = loaded;
  forced_ = loaded || !forces.empty();
  only_ = loaded || forces.empty() ? nullptr : horizon_.find_only(forces, only_force_);
  if (forces.empty()) {
    if (loaded) modal_force_.swap(inertial_load_);
    return move_on();
  }
  for (std::size_t i = 0; i < modes_; i += kSlice) {
    const ModeRange slice{i, std::min(kSlice, modes_ - i)};
    collect_modal_forces(forces, slice, modal_force_.data());
    push_and_transit({&a11_[i], &a12_[i], &a21_[i], &a22_[i]}, {&b1_[i], &b2_[i], &modal_force_[i]},
                     &coordinate_[i], &velocity_[i], &free_coordinate_[i], &free_velocity_[i],
                     slice.count);
    if (loaded) add_to(&modal_force_[i], &inertial_load_[i], slice.count);
  }
  add_gravity();
}

// Some rows of Phi at a time: the first engine has them read from memory, the others find them in
// the cache.
template <typename Scalar>
void ModalEngine<Scalar>::displacements(std::span<const SurfaceRequest> requests) const {
  struct Part {
    const ModalEngine* engine;
    std::vector<ModeRange> modes;
    double* u;
  };
  std::vector<Part> parts;
  for (const SurfaceRequest& request : requests) {
    const auto* engine = static_cast<const ModalEngine*>(request.engine);
    request.u->setZero(model_->mesh.surface_node_count(), 3);
    parts.push_back({engine,
                     active_modes(engine->coordinate_, engine->largest_shape_, request.tolerance),
                     request.u->data()});
  }
  const auto dof = static_cast<std::size_t>(shapes_->rows());
  const auto blocks = static_cast<int>((dof + kBlock - 1) / kBlock);
#pragma omp parallel for schedule(dynamic)
  for (int block = 0; block < blocks; ++block) {
    const std::size_t first = static_cast<std::size_t>(block) * kBlock;
    const std::size_t count = std::min(kBlock, dof - first);
    for (const Part& part : parts) {
      for (const ModeRange& range : part.modes) {
        add_products({shape_row(static_cast<int>(first)) + range.first, modes_, count},
                     part.engine->coordinate_.data() + range.first, range.count, 1.0,
                     part.u + first);
      }
    }
  }
  for (const SurfaceRequest& request : requests) {
    const auto* engine = static_cast<const ModalEngine*>(request.engine);
    engine->residual_.add_displacement(*request.u);
    engine->gravity_.add_rest(*request.u);
  }
}

template <typename Scalar>
void ModalEngine<Scalar>::reset() noexcept {
  residual_.release();
  change_state();
  begun_ = false;
  settle();
}

// Responses that were looked ahead of are found anew.
template <typename Scalar>
void ModalEngine<Scalar>::archive(StateArchive& state) {
  if (state.reading()) change_state();
  for (auto* values : {&coordinate_, &velocity_, &free_coordinate_, &free_velocity_, &modal_force_,
                       &inertial_load_}) {
    state.values(*values);
  }
  for (bool* flag : {&loaded_, &was_loaded_, &forced_, &begun_}) state.value(*flag);
  residual_.archive(state);
  gravity_.archive(state);
  if (state.reading()) only_ = nullptr;
}

// Modes are mass-normalised: 1/2 sum (v^2 + omega^2 q^2); gravity holds each with g_i.
template <typename Scalar>
double ModalEngine<Scalar>::energy() const noexcept {
  const auto& omega = std::get_if<ModalResponse>(&model_->response)->angular_frequency;
  const auto count = static_cast<Eigen::Index>(modes_);
  const Eigen::Map<const Eigen::ArrayXd> q(coordinate_.data(), count);
  const Eigen::Map<const Eigen::ArrayXd> v(velocity_.data(), count);
  double sum = 0.5 * (v.square() + (omega.head(count).array() * q).square()).sum();
  if (gravity_.acts()) {
    for (std::size_t i = 0; i < modes_; ++i) sum -= gravity_.force()[i] * coordinate_[i];
  }
  return sum + residual_.energy();
}

template class ModalEngine<float>;
template class ModalEngine<double>;

}  // namespace irdm
