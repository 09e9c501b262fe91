#include "device_bridge/commission/obedient_hand.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace irdm::commission {
namespace {

constexpr double kMoveWay = 0.05;    // [m]
constexpr double kMoveSpeed = 0.1;   // [m/s]
constexpr double kPressAt = 0.3;     // [s]
constexpr double kPressUntil = 0.6;  // [s]
constexpr double kStopAt = 2.5;      // the force has grown by then [s]
constexpr double kTapDepth = 0.012;  // [m]
constexpr double kTapPeriod = 1.0;   // [s]

}  // namespace

void ObedientHand::obey(const Order& order) noexcept {
  home_ = wish();
  order_ = order;
  time_ = 0.0;
}

Vector3 ObedientHand::wish() const noexcept {
  if (order_.kind == Order::Kind::kMove) {
    return home_ + std::min(kMoveSpeed * time_, kMoveWay) * order_.direction;
  }
  if (order_.kind == Order::Kind::kTap) {
    const double phase = 2.0 * std::numbers::pi * time_ / kTapPeriod;
    return home_ - 0.5 * kTapDepth * (1.0 - std::cos(phase)) * Vector3::UnitY();
  }
  return home_;
}

void ObedientHand::advance(double dt, const Vector3& force) noexcept {
  time_ += dt;
  hand_.advance(dt, wish(), force);
}

std::uint32_t ObedientHand::buttons() const noexcept {
  const bool presses = order_.kind == Order::Kind::kPress;
  const bool stops = order_.kind == Order::Kind::kStop;
  const bool down =
      (presses && time_ >= kPressAt && time_ < kPressUntil) || (stops && time_ >= kStopAt);
  return down && order_.button >= 0 ? 1u << order_.button : 0u;
}

bool ObedientHand::unplugs() const noexcept {
  return order_.kind == Order::Kind::kUnplug && time_ >= kStopAt;
}

}  // namespace irdm::commission
