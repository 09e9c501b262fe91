#include "device_bridge/safety/arming.hpp"

#include <algorithm>

#include "common/realtime/clock.hpp"

namespace irdm {

void Arming::arm() noexcept {
  if (state_ != FilterState::kDisarmed && state_ != FilterState::kArmed) return;
  state_ = FilterState::kArmed;
  action_ = true;
  pause_ = 0.0;
}

void Arming::drop(FilterState state) noexcept {
  state_ = state;
  action_ = false;
  share_ = 0.0;
}

void Arming::disarm() noexcept {
  drop(FilterState::kDisarmed);
}

void Arming::trip() noexcept {
  if (state_ == FilterState::kDisarmed || state_ == FilterState::kFault) return;
  drop(FilterState::kArmed);
  pause_ = kNanosecond * static_cast<double>(limits_.pause_ns);
}

void Arming::fail() noexcept {
  if (!guards_.on(Guard::kLatch)) return trip();
  if (state_ != FilterState::kDisarmed) drop(FilterState::kFault);
}

double Arming::step(double elapsed, double fresh, double demand) noexcept {
  if (state_ == FilterState::kDisarmed && !guards_.on(Guard::kArming)) state_ = FilterState::kArmed;
  if (state_ == FilterState::kDisarmed || state_ == FilterState::kFault) return 0.0;
  if (state_ == FilterState::kArmed) {
    pause_ -= elapsed;
    if (fresh < 1.0 || pause_ > 0.0) return 0.0;
    state_ = FilterState::kEngaged;
  }
  const double ramp = elapsed / (kNanosecond * static_cast<double>(limits_.ramp_ns));
  const bool at_once =
      fresh == 1.0 && ((action_ && demand <= limits_.small_force) || !guards_.on(Guard::kRamp));
  share_ = at_once ? 1.0 : std::min(share_ + ramp, fresh);
  if (share_ == 1.0) action_ = false;
  state_ = fresh < 1.0 ? FilterState::kFading : FilterState::kEngaged;
  if (state_ == FilterState::kFading && share_ <= 0.0) drop(FilterState::kArmed);
  return share_;
}

}  // namespace irdm
