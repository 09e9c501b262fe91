#include "device_bridge/commission/wall_step.hpp"

#include <algorithm>

namespace irdm::commission {

WallStep::WallStep()
    : Step("wall", {{.kind = Order::Kind::kTap},
                    "There is a wall 5 mm below the handle. Press onto it and lift off, again and "
                    "again: it becomes stiffer until it would shake."}) {}

Demand WallStep::tick(const Seen& seen) noexcept {
  watch_.look(seen);
  oscillates_ = oscillates_ || seen.gain < 1.0;
  active_ = active_ || oscillates_;
  if (!seen.tip.allFinite() || over()) return {};
  const double depth = watch_.start().y() - kDistance - seen.tip.y();
  judge_press(seen, depth > 0.0);
  if (depth > 0.0 && seen.shown.y() >= kFelt) pressed_ += seen.elapsed;
  if (depth <= 0.0 && pressed_ >= kPressed) {
    ++level_;
    pressed_ = 0.0;
  }
  if (over()) return {};
  return {.force = std::max(0.0, depth) * kStiffness[level_] * Vector3::UnitY(), .contact = true};
}

// A press gives back no more than it took: by what was shown since the tick before.
void WallStep::judge_press(const Seen& seen, bool touched) noexcept {
  if (touched && !touched_) given_ = 0.0;
  if (touched_) given_ += shown_.dot(seen.tip - tip_);
  if (!touched && touched_ && given_ > kMostGiven) active_ = true;
  touched_ = touched;
  tip_ = seen.tip;
  shown_ = seen.shown;
}

bool WallStep::over() const noexcept {
  return active_ || level_ == kStiffness.size() || watch_.trouble() != nullptr ||
         watch_.time() >= kLongest;
}

Judgement WallStep::judge(Measured& measured) const {
  const std::string at =
      level_ < kStiffness.size() ? " at " + in_unit(kStiffness[level_], "N/m") : "";
  if (watch_.trouble() != nullptr) return {false, watch_.trouble() + at};
  const std::string activity =
      oscillates_ ? "the oscillation detector acts" + at : "more energy is given than taken" + at;
  if (level_ == 0) {
    return {false, (active_ ? activity + "; see jitter and noise of the steps before"
                            : "the wall was not pressed; press onto it and lift off") +
                       "; run it again"};
  }
  if (!active_ && level_ < kStiffness.size()) {
    return {false, "not pressed for long enough" + at + "; press onto it and lift off"};
  }
  const double stiffest = kStiffness[level_ - 1];
  measured.wall_stiffness = stiffest;
  measured.coupling_stiffness = kProposed * stiffest;
  return {true, "passive up to " + in_unit(stiffest, "N/m") + (active_ ? ", " + activity : "") +
                    "; coupling_stiffness = " + in_unit(kProposed * stiffest, "N/m") +
                    " is proposed, half of it"};
}

}  // namespace irdm::commission
