#include "device_bridge/contact/bridge_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace irdm {

BridgeContact::BridgeContact(double dt, std::int64_t tick_ns) noexcept
    : pacer_(dt, tick_ns),
      dt_(dt),
      steps_a_tick_(
          std::max(1, static_cast<int>(std::lround(1e-9 * static_cast<double>(tick_ns) / dt)))) {}

void BridgeContact::receive(const ContactModel& model, std::int64_t now_ns) noexcept {
  if (model.paused) {  // nothing goes on from here: when the run does, all begins anew
    pacer_.stop();
    wanted_.paused = true;
    return;
  }
  if (pacer_.running() && model.step <= newest_model_) return;
  wanted_.paused = false;
  if (!pacer_.running()) {
    predictor_.reset();
    in_contact_ = false;
    last_tip_.reset();
    history_ = AppliedHistory{};
  }
  newest_model_ = model.step;
  energy_ = model.energy;
  known_ = model.newest_known();
  horizon_ns_ = std::llround(1e9 * dt_ * (model.valid ? model.horizon : kMaxHorizon));
  pacer_.hear(model.step, model.newest == kNoStep ? std::nullopt : std::optional(model.newest),
              in_contact_, now_ns);
  predictor_.receive(model);
  // A pacer that waits for a slow server solves nothing meanwhile, and its force is as good as it
  // was.
  if (wanted_.any)
    wanted_.content_ns = std::max(wanted_.content_ns, pacer_.end_of(model.step, now_ns));
}

// A tip that several steps share has come to where it is evenly. In steps that ended before the
// last tick should have been the device went on showing what it showed.
bool BridgeContact::tick(std::int64_t now_ns, const Vector3& tip) noexcept {
  const std::uint64_t before = pacer_.step();
  const int count = pacer_.due(now_ns);
  for (int i = 1; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    const Vector3 from = last_tip_.value_or(tip);
    const std::uint64_t k = before + static_cast<std::uint64_t>(i);
    const Vector3 there = from + share * (tip - from);
    if (i > count - steps_a_tick_) {
      solve(k, now_ns, there);
    } else {
      predictor_.hold(k);
      remember(k, there);
    }
  }
  if (count > 0) last_tip_ = tip;
  ended_ = std::min(count, steps_a_tick_);
  history_.take(applied_);
  wanted_.energy = energy_left();
  return count > 0;
}

void BridgeContact::shown(const Vector3& force) noexcept {
  const int count = std::min(std::exchange(ended_, 0), applied_.count);
  for (int i = 0; i < count; ++i) {
    const std::uint64_t step = applied_.step - static_cast<std::uint64_t>(i);
    predictor_.show(step, -force);
    applied_.past[static_cast<std::size_t>(i)].force = predictor_.applied(step);
  }
  history_.take(applied_);
}

void BridgeContact::solve(std::uint64_t k, std::int64_t now_ns, const Vector3& tip) noexcept {
  const ContactPredictor::Answer answer = predictor_.solve(k, tip);
  remember(k, tip);
  if (!answer.known) {  // what was wanted last grows old
    withheld_ += in_contact_ ? 1 : 0;
    return;
  }
  in_contact_ = answer.state != ContactState::kFree;
  wanted_ = {.any = true,
             .content_ns = std::max(wanted_.content_ns, pacer_.end_of(newest_model_, now_ns)),
             .horizon_ns = horizon_ns_,
             .solved_ns = now_ns,
             .contact = answer.state,
             .force = -answer.force,
             .normal = answer.normal};
}

void BridgeContact::remember(std::uint64_t k, const Vector3& tip) noexcept {
  auto& past = applied_.past;
  const bool follows = applied_.count > 0 && k == applied_.step + 1;
  std::shift_right(past.begin(), past.end(), 1);
  past[0] = {predictor_.applied(k), tip, predictor_.arm(k)};
  applied_.step = k;
  applied_.base = newest_model_;
  applied_.count = follows ? std::min(applied_.count + 1, AppliedForces::kSteps) : 1;
}

// The model's, with the hand's work since: a force is shown after its step.
double BridgeContact::energy_left() const noexcept {
  double left = energy_;
  for (std::uint64_t k = known_; k < applied_.step && k < known_ + AppliedHistory::kKept; ++k) {
    const AppliedForce* const shown = history_.find(k);
    const AppliedForce* const next = history_.find(k + 1);
    if (shown != nullptr && next != nullptr) left += shown->force.dot(next->tip - shown->tip);
  }
  return left;
}

std::uint64_t BridgeContact::lookahead() const noexcept {
  return pacer_.running() && pacer_.step() > newest_model_ ? pacer_.step() - newest_model_ : 0;
}

}  // namespace irdm
