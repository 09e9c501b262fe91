#include "device_bridge/commission/guided_stylus.hpp"

namespace irdm::commission {

StylusPose GuidedStylus::read(double time) noexcept {
  const double elapsed = std::max(0.0, time - time_);
  time_ = time;
  if (orders_.receive()) hand_.obey(orders_.front());
  hand_.advance(elapsed, motors_.shown().force);
  motors_.advance(elapsed);
  return {.tip = sensor_.measure(hand_.tip()), .buttons = hand_.buttons()};
}

}  // namespace irdm::commission
