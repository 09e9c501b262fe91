#include "simulation/step/assembly_horizon.hpp"

#include <cmath>

#include "common/contact/applied_forces.hpp"
#include "common/motion/free_motion.hpp"

namespace irdm {
namespace {

// In which the velocity of another tip is expected to die away [s]. What a hand does later nobody
// knows; a tip that is said to go on at its velocity feeds energy into a pinch across a delay.
constexpr double kOthersVelocityTime = 0.01;

}  // namespace

void AssemblyHorizon::answer(const Contact& other, ContactModel& model, const ContactPatch& patch,
                             const Vector3& force, std::span<const NodalForce> held,
                             ResponseEngine& engine) noexcept {
  find_compliance(other, model, patch, held, engine);
  find_changes(other, model, force);
  const auto steps = static_cast<std::size_t>(model.horizon);
  find_answers(other, steps);
  Vector3 by_own = Vector3::Zero();
  for (std::size_t n = 0; n < steps; ++n) {
    Vector3 moved = Vector3::Zero();
    Matrix3 answer = Matrix3::Zero();
    for (std::size_t i = 0; i <= n; ++i) {
      moved += shared_[n - i] * change_[i];
      answer.noalias() += shared_[n - i] * answer_[i];
    }
    answer = 0.5 * (answer + answer.transpose()).eval();
    by_own += answer * force;
    model.path[n] += moved - by_own;  // the change rests on that force, the response gives it back
    model.response[n] += answer;
  }
}

void AssemblyHorizon::find_compliance(const Contact& other, const ContactModel& model,
                                      const ContactPatch& patch, std::span<const NodalForce> held,
                                      ResponseEngine& engine) noexcept {
  const auto steps = static_cast<std::size_t>(model.horizon);
  engine.predict_horizon(other.patch, held, {path_.data(), steps}, {own_.data(), steps});
  engine.cross_response(patch, other.patch, {shared_.data(), steps});
  const RigidMobility mobility = RigidBody(model.body, model.dt).mobility();
  const Vector3 arm = other.place + path_[0];
  const Matrix3 own = mobility.between(arm, arm);
  const Matrix3 shared = mobility.between(model.place + model.path[0], arm);
  for (std::size_t n = 0; n < steps; ++n) {
    const double after = 2.0 * static_cast<double>(n) + 1.0;
    own_[n] += after * own;
    shared_[n] += after * shared;
  }
}

// While the model's contact goes on with this force. With h where the place would be under the held
// forces and f the force of the other one, W (f_n - held) + series f_n = p - h - what was before.
void AssemblyHorizon::find_changes(const Contact& other, const ContactModel& model,
                                   const Vector3& force) noexcept {
  const RigidBody body(model.body, model.dt);
  const Matrix3 W = own_[0] + other.series * Matrix3::Identity();
  RigidState motion = model.motion;
  Vector3 slid = Vector3::Zero();
  Vector3 by_force = Vector3::Zero();
  for (std::size_t n = 0; n < static_cast<std::size_t>(model.horizon); ++n) {
    const FreeMotion free = free_motion(body, model.free_forces, motion);
    motion = end_of_step(body, model.free_forces, free, free.halfway * model.other_force,
                         free.halfway * model.other_torque);
    const double time = model.dt * static_cast<double>(n + 1);
    const double lasting = kOthersVelocityTime * (1.0 - std::exp(-time / kOthersVelocityTime));
    const Vector3 tip = other.tip + lasting * other.velocity;
    by_force += shared_[n].transpose() * force;
    Vector3 gap = motion.orientation.conjugate() * (tip - motion.position) -
                  (other.place + slid + path_[n] + by_force) + own_[0] * other.force;
    for (std::size_t i = 0; i < n; ++i) gap -= own_[n - i] * change_[i];
    const SingleContact found =
        solve_single_contact(W, gap, other.law, other.normal, other.friction);
    change_[n] = bounded_force(found.force) - other.force;
    slid += found.slip;
    if (n != 0) continue;
    constraint_.setZero();
    if (found.mode == ContactMode::kSticking) constraint_.setIdentity();
    if (found.mode == ContactMode::kSlipping) {
      constraint_ = other.normal * other.normal.transpose();
    }
  }
}

void AssemblyHorizon::find_answers(const Contact& other, std::size_t steps) noexcept {
  const Matrix3& P = constraint_;
  const Matrix3 W = own_[0] + other.series * Matrix3::Identity();
  const Matrix3 inverse = (P * W * P + Matrix3::Identity() - P).inverse();
  for (std::size_t n = 0; n < steps; ++n) {
    Matrix3 moved = shared_[n].transpose();
    for (std::size_t i = 0; i < n; ++i) moved.noalias() += own_[n - i] * answer_[i];
    answer_[n] = -inverse * (P * moved);
  }
}

}  // namespace irdm
