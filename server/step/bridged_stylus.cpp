#include "server/step/bridged_stylus.hpp"

#include <algorithm>

namespace irdm {
namespace {

// No contact model is good for longer [s].
constexpr double kLongestHorizon = 0.05;

}  // namespace

const AppliedForce* BridgedStylus::find(const AppliedHistory& history,
                                        std::uint64_t step) const noexcept {
  return step >= first_ ? history.find(step) : nullptr;
}

StylusCommand BridgedStylus::next(const StylusCommand& command, const AppliedHistory& history,
                                  std::uint64_t k) noexcept {
  StylusCommand next = command;
  if (!command.present) {
    forget(history);
    return next;
  }
  const bool any = history.newest() != kNoStep && history.newest() >= first_;
  if (any && !bridged_) {  // it begins: there is nothing from before that may yet come
    bridged_ = true;
    known_ = ~std::uint64_t{0};
    tip_ = command.tip;
    std::uint64_t told = history.newest();
    while (told > first_ && history.find(told - 1) != nullptr) --told;
    first_ = told;
  }
  newest_ = any ? history.newest() : kNoStep;
  if (!bridged_) {
    tip_ = command.tip;
    return next;
  }
  enter_late(history, k);
  const AppliedForce* const applied = find(history, k);
  known_ = known_ << 1 | (applied != nullptr || k < first_ ? 1 : 0);
  next.tip = applied != nullptr ? applied->tip : tip_;
  next.bridged = applied != nullptr ? applied->force : Vector3::Zero();
  tip_ = next.tip;
  return next;
}

// Bit i of known_ is step k - 1 - i.
void BridgedStylus::enter_late(const AppliedHistory& history, std::uint64_t k) noexcept {
  constexpr std::uint64_t kOldest = kMaxHorizon - 1;
  for (std::uint64_t i = 0; i <= kOldest && i < k; ++i) {
    if ((known_ >> i & 1) != 0) continue;
    const AppliedForce* const applied = find(history, k - 1 - i);
    if (applied == nullptr) {
      if (i == kOldest) ++lost_;
      continue;
    }
    known_ |= std::uint64_t{1} << i;
    if (applied->force.isZero(0.0)) continue;
    ++(simulation_.enter_late(s_, applied->force, static_cast<int>(i)) ? late_ : lost_);
  }
}

void BridgedStylus::foresee(ContactModel& model) noexcept {
  const auto horizon = static_cast<int>(kLongestHorizon / simulation_.dt() + 1e-6);
  simulation_.foresee(s_, tip_, std::clamp(horizon, 1, kMaxHorizon), model);
  model.missing = ~known_ & ((std::uint64_t{1} << kMaxHorizon) - 1);
  model.newest = newest_;
  model.standing = false;
}

void BridgedStylus::forget(const AppliedHistory& history) noexcept {
  bridged_ = false;
  known_ = ~std::uint64_t{0};
  first_ = history.newest() == kNoStep ? 0 : history.newest() + 1;
}

}  // namespace irdm
