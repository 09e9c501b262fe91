#include "device_bridge/commission/reading_steps.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/realtime/clock.hpp"

namespace irdm::commission {
namespace {

Request move_request(int axis) {
  const std::string to = direction_word(axis);
  return {{.kind = Order::Kind::kMove, .direction = Vector3::Unit(axis)},
          "Move the handle 5 cm " + to + ", only " + to + ", and hold it there."};
}

std::string bits(std::uint32_t buttons) {
  std::string text;
  for (; buttons != 0; buttons &= buttons - 1) {
    text += (text.empty() ? "" : ", ") + std::to_string(std::countr_zero(buttons));
  }
  return text;
}

}  // namespace

AxisStep::AxisStep(int axis)
    : Step(std::string("axis ") + direction_word(axis), move_request(axis)), axis_(axis) {}

bool AxisStep::clear() const noexcept {
  return way_.cwiseAbs().maxCoeff() >= kWay && along_an_axis(way_);
}

Demand AxisStep::tick(const Seen& seen) noexcept {
  time_ += seen.elapsed;
  if (!seen.tip.allFinite()) return {};
  if (!begun_) start_ = seen.tip;
  begun_ = true;
  way_ = seen.tip - start_;
  return {};
}

Judgement AxisStep::judge(Measured&) const {
  const std::string wanted = axis_word(Vector3::Unit(axis_));
  const std::string to = direction_word(axis_);
  if (!clear()) {
    return {false, "no clear movement: the readings went " + in_unit(1e3 * way_.x(), "mm, ") +
                       in_unit(1e3 * way_.y(), "mm, ") + in_unit(1e3 * way_.z(), "mm") +
                       "; move 5 cm along one direction"};
  }
  const std::string found = axis_word(way_);
  if (found == wanted) return {true, to + " is " + wanted};
  const std::string remedy =
      "; stand in front of the device, and correct its setup by the vendor's program";
  const bool reversed = found[1] == wanted[1];
  return {false, to + " is " + found + ", not " + wanted +
                     (reversed ? ": the sign is wrong" : ": axes are swapped") + remedy};
}

ButtonStep::ButtonStep(const std::string& function, int bit)
    : Step("button " + function, {{.kind = Order::Kind::kPress, .button = bit},
                                  "Press and release the button to " + function + "."}),
      function_(function),
      bit_(bit) {}

Demand ButtonStep::tick(const Seen& seen) noexcept {
  time_ += seen.elapsed;
  if (!begun_) before_ = seen.buttons;
  begun_ = true;
  pressed_ |= seen.buttons & ~before_;
  released_ |= pressed_ & ~seen.buttons;
  return {};
}

Judgement ButtonStep::judge(Measured&) const {
  const std::string bit = std::to_string(bit_);
  if ((released_ >> bit_ & 1u) != 0) return {true, "bit " + bit};
  if (released_ != 0) {
    return {false, "bit " + bits(released_) + " changed, not " + bit + "; set buttons." +
                       function_ + " = " + bits(released_) + ", or press the other button"};
  }
  return {false, "no button was seen; set buttons." + function_ + " = -1 if there is none"};
}

RestStep::RestStep()
    : Step("rest noise", {{.kind = Order::Kind::kRest},
                          "Let the handle rest: in its dock, on the table, or held still."}) {}

Demand RestStep::tick(const Seen& seen) noexcept {
  time_ += seen.elapsed;
  since_ += seen.elapsed;
  if (!seen.tip.allFinite()) {
    ++unusable_;
  } else if (!seen.device.repeated) {
    add(seen.tip);
  }
  return {};
}

void RestStep::add(const Vector3& tip) noexcept {
  if (readings_ == 0) first_ = last_ = tip;
  if (readings_ > 0 && since_ > 0.0) speed_squares_ += ((tip - last_) / since_).cwiseAbs2();
  since_ = 0.0;
  last_ = tip;
  ++readings_;
  drift_ = std::max(drift_, (tip - first_).norm());
  if (in_window_ == 0) origin_ = tip;
  sum_ += tip - origin_;
  squares_ += (tip - origin_).cwiseAbs2();
  if (++in_window_ == kWindow) end_window();
}

void RestStep::end_window() noexcept {
  variances_ += squares_ / kWindow - (sum_ / kWindow).cwiseAbs2();
  ++windows_;
  sum_.setZero();
  squares_.setZero();
  in_window_ = 0;
}

Judgement RestStep::judge(Measured& measured) const {
  if (readings_ < kFewestReadings) {
    return {false, "only " + std::to_string(readings_) + " readings in 2 s; see `doctor`"};
  }
  const double position = std::sqrt(std::max(0.0, variances_.maxCoeff() / windows_));
  const double velocity = std::sqrt(speed_squares_.maxCoeff() / static_cast<double>(readings_ - 1));
  measured.position_noise = position;
  measured.velocity_noise = velocity;
  const std::string words =
      "position " + in_unit(1e3 * position, "mm") + ", velocity " + in_unit(velocity, "m/s");
  const std::string remedy = "; keep power cables away, and check the encoders' cable";
  if (unusable_ > 0)
    return {false, std::to_string(unusable_) + " readings were of no use" + remedy};
  if (drift_ > kMostDrift) {
    return {false, "the handle moved by " + in_unit(1e3 * drift_, "mm") + "; let it rest"};
  }
  if (position > kMostPosition) {
    return {false, words + ": the encoder is noisy, at most 0.1 mm" + remedy};
  }
  if (velocity > kMostVelocity) {
    return {false, words + ": the encoder is noisy, at most 0.1 m/s" + remedy};
  }
  return {true, words};
}

RateStep::RateStep(double rate)
    : Step("loop rate", {{.kind = Order::Kind::kRest}, "Let the handle rest for three seconds."}),
      rate_(rate) {}

Demand RateStep::tick(const Seen& seen) noexcept {
  if (seen.device.repeated) ++repeated_;
  if (seen.elapsed <= 0.0) return {};
  time_ += seen.elapsed;
  ++ticks_;
  off_.add(std::llround(kNanosecondsPerSecond * std::abs(seen.elapsed - 1.0 / rate_)));
  return {};
}

Judgement RateStep::judge(Measured& measured) const {
  const double rate = static_cast<double>(ticks_) / time_;
  const double jitter = kNanosecond * static_cast<double>(off_.percentile(0.99));
  const double readings = static_cast<double>(ticks_ - std::min(ticks_, repeated_)) / time_;
  measured.rate = rate;
  measured.jitter = jitter;
  measured.readings = readings;
  const std::string wanted = in_unit(rate_, "Hz");
  const std::string words = in_unit(rate, "Hz") + ", jitter " + in_unit(1e3 * jitter, "ms") +
                            ", new readings " + in_unit(readings, "Hz");
  const std::string remedy =
      "; run less beside it, permit real-time priority (`doctor`), or lower bridge.rate";
  if (rate < kLeastRate * rate_) {
    return {false, words + ": the loop is too slow, " + wanted + " are configured" + remedy};
  }
  if (jitter > 1.0 / rate_) {
    return {false, words + ": ticks come a whole period too late" + remedy};
  }
  if (readings < kLeastReadings * rate_) {
    return {false, words + ": the device is too slow; use a USB port of the machine itself"};
  }
  return {true, words};
}

}  // namespace irdm::commission
