#include "simulation/step/stylus_ball.hpp"

namespace irdm {

StylusBall::StylusBall(double radius, double stiffness)
    : compliance_(stiffness > 0.0 ? 1.0 / stiffness : 0.0) {
  body_.now.shape = SphereShape{radius};
  body_.led = true;
  body_.present = false;
}

void StylusBall::reset() noexcept {
  body_.present = false;
  reference_.setZero();
  held_.setZero();
  force_.setZero();
  strongest_ = {};
}

void StylusBall::archive(StateArchive& state) {
  for (Vector3* vector : {&body_.now.position, &body_.before, &body_.origin, &body_.recoil, &tip_,
                          &centre_, &reference_, &held_, &force_}) {
    state.value(*vector);
  }
  state.value(body_.present);
  state.value(strongest_);
}

bool StylusBall::begin(const StylusCommand& command) noexcept {
  const bool present = command.present && command.tip.allFinite();
  const bool stays = present == body_.present;
  body_.present = present;
  force_.setZero();
  strongest_ = {};
  if (!present) return stays;
  tip_ = command.tip;
  if (!stays) {
    reference_.setZero();
    held_.setZero();
    body_.now.position = centre_ = tip_;
  }
  body_.origin = body_.now.position;
  body_.before = centre_;
  body_.recoil = compliance_ * reference_;
  body_.now.position = centre_ = tip_ - compliance_ * (reference_ + held_);
  return stays;
}

void StylusBall::end(const Vector3& force, const Vector3& held, const Touch& strongest,
                     bool solved) noexcept {
  force_ = force;
  held_ = held;
  strongest_ = strongest;
  if (solved) reference_ = force;
  centre_ = tip_ - compliance_ * (force + held);
}

}  // namespace irdm
