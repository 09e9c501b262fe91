#include "simulation/step/bridged_stylus.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace irdm {

const AppliedForce* BridgedStylus::find(const AppliedHistory& history,
                                        std::uint64_t step) const noexcept {
  return step >= first_ ? history.find(step) : nullptr;
}

StylusCommand BridgedStylus::next(const StylusCommand& command, std::uint64_t session,
                                  const AppliedHistory& history) noexcept {
  StylusCommand next = command;
  const std::uint64_t k = simulation_.next_step();
  if (session != session_) {  // a new hand: what the last one touched is nothing to it
    session_ = session;
    forget(AppliedHistory{});
    there_ = false;
    next.present = false;
  }
  const bool ours = session != 0 && history.session() == session;
  if (!next.present || !ours) {
    if (ours) forget(history);
    there_ = false;
    return next;
  }
  if (!std::exchange(there_, true)) {  // from where it was before no hand came
    tip_ = command.tip;
    path_.begin(command.tip);
  }
  path_.add(command.tip);
  if (reset_ != simulation_.reset_step() && history.base() < simulation_.reset_step()) {
    forget(history);  // all of it is for the object as it was before
    next.bridged = BridgedForce{};
    return next;
  }
  if (reset_ != simulation_.reset_step()) {
    reset_ = simulation_.reset_step();
    first_ = history.newest();  // the only one that surely rests on a model from after it
  }
  const bool any = history.newest() != kNoStep && history.newest() >= first_;
  if (any) horizon_.follow(history);
  if (any && !bridged_) begin(command, history);
  newest_ = any ? history.newest() : kNoStep;
  if (!bridged_) {
    tip_ = command.tip;
    return next;
  }
  insert_delayed_force(history, k);
  const AppliedForce* const applied = find(history, k);
  known_ = known_ << 1 | (applied != nullptr || k < first_ ? 1 : 0);
  ++untold_;
  if (applied != nullptr) follow(*applied);
  next.tip = tip_;
  next.bridged = BridgedForce{.object = simulation_.local_model_object(s_)};
  if (applied != nullptr) {
    const AppliedForce here = accepted(*applied, tip_);
    exerted_ = !here.force.isZero(0.0);
    next.bridged->force = here.force;
    next.bridged->arm = here.arm;
    const std::uint64_t reached = history.base_of(k) + static_cast<std::uint64_t>(horizon_.steps());
    withheld_ += k > reached && in_contact() ? 1 : 0;
  }
  return next;
}

// A hand that feels no force may be as fast as it likes.
void BridgedStylus::follow(const AppliedForce& applied) noexcept {
  const double time = simulation_.dt() * std::exchange(untold_, 0);
  const double longest = exerted_ ? kFastestHand * time : std::numeric_limits<double>::infinity();
  tip_ = path_.follow(applied.tip, longest);
}

bool BridgedStylus::in_contact() const noexcept {
  const int object = simulation_.local_model_object(s_);
  return object >= 0 && simulation_.object(object).contact_state(s_) != ContactState::kFree;
}

// What the bridge told, with the tip where the samples are.
AppliedForce BridgedStylus::accepted(const AppliedForce& applied, const Vector3& tip) noexcept {
  const double most = simulation_.max_force(s_);
  AppliedForce accepted{applied.force, tip, applied.arm};
  if (accepted.force.isZero(0.0)) return accepted;
  if ((applied.tip - tip).norm() > kAgrees) {
    ++disagreed_;
    accepted.force.setZero();
  } else if (accepted.force.norm() > most) {
    ++bounded_;
    accepted.force = bounded_force(accepted.force, most);
  }
  return accepted;
}

// There is nothing from before that may yet come.
void BridgedStylus::begin(const StylusCommand& command, const AppliedHistory& history) noexcept {
  bridged_ = true;
  known_ = ~std::uint64_t{0};
  tip_ = command.tip;
  std::uint64_t told = history.newest();
  while (told > first_ && history.find(told - 1) != nullptr) --told;
  first_ = told;
}

// The earliest first. Bit i of known_ is step k - 1 - i. What finds no place is left out for good;
// what finds no room waits for the next step.
void BridgedStylus::insert_delayed_force(const AppliedHistory& history, std::uint64_t k) noexcept {
  constexpr int kOldest = kMaxHorizon - 1;
  for (int i = static_cast<int>(std::min<std::uint64_t>(kMaxHorizon, k)) - 1; i >= 0; --i) {
    if ((known_ >> i & 1) != 0) continue;
    const AppliedForce* const applied = find(history, k - 1 - static_cast<std::uint64_t>(i));
    if (applied == nullptr || (simulation_.late_room() == 0 && !applied->force.isZero(0.0))) {
      if (i == kOldest) ++lost_;
      continue;
    }
    known_ |= std::uint64_t{1} << i;
    const Vector3 tip = path_.ahead(applied->tip);
    simulation_.tell_late(s_, tip, i);
    if (applied->force.isZero(0.0)) continue;
    const AppliedForce late = accepted(*applied, tip);
    if (late.force.isZero(0.0)) continue;
    exerted_ = true;
    ++(simulation_.insert_delayed_force(s_, late, i) ? late_ : lost_);
  }
}

// Whether tip and surface would meet at the bridge within two periods, going on as they did since
// the last model.
bool BridgedStylus::touches_soon(const ContactModel& model) noexcept {
  constexpr double kNear = 1e-3;  // [m]
  if (!model.valid || model.state != ContactState::kFree) {
    gap_.reset();
    return true;
  }
  const RigidState& object = model.motion;
  const Vector3 place = object.position + object.orientation * (model.place + model.path[0]);
  const Vector3 gap = tip_ - place;
  const double moved = (gap - std::exchange(gap_, gap).value_or(Vector3::Zero())).norm();
  return gap.norm() < kNear + static_cast<double>(2 * kFarModelPeriod + horizon_.lead()) * moved;
}

bool BridgedStylus::predict_horizon(ContactModel& model, int& budget) noexcept {
  const std::uint64_t k = simulation_.next_step();
  if (k < next_model_) return false;
  if (!simulation_.predict_horizon(s_, tip_, horizon_.steps(), model, budget)) return false;
  next_model_ = touches_soon(model) ? k : k + kFarModelPeriod;
  model.missing = ~known_ & ((std::uint64_t{1} << kMaxHorizon) - 1);
  model.newest = newest_;
  model.paused = false;
  return true;
}

void BridgedStylus::forget(const AppliedHistory& history) noexcept {
  bridged_ = false;
  next_model_ = 0;
  gap_.reset();
  known_ = ~std::uint64_t{0};
  first_ = history.newest() == kNoStep ? 0 : history.newest() + 1;
}

}  // namespace irdm
