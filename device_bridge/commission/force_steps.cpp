#include "device_bridge/commission/force_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "device_bridge/commission/reading_steps.hpp"

namespace irdm::commission {
namespace {

// From 0 to 1 between two times.
double rising(double time, double from, double to) noexcept {
  return std::clamp((time - from) / (to - from), 0.0, 1.0);
}

}  // namespace

void ForceWatch::look(const Seen& seen) noexcept {
  time_ += seen.elapsed;
  const bool usable = seen.tip.allFinite();
  if (!begun_ && usable) start_ = seen.tip;
  begun_ = begun_ || usable;
  if (trouble_ != nullptr) return;
  if (seen.fault || seen.device.failed) {
    trouble_ = "the device reports a fault";
  } else if (!seen.device.ready) {
    trouble_ = "the device is not ready";
  } else if (usable && (seen.tip - start_).norm() > kFarthest) {
    trouble_ = "the handle moved away by 10 cm; hold it";
  }
}

namespace {

// Of a ForceSignStep [s]: it rests, and then has the force, its opposite, and both once more.
constexpr double kRest = 0.6, kRising = 0.3, kPhase = 1.0, kTurning = 0.4;
constexpr double kMeasured = 0.2;   // at the end of each phase
constexpr double kAgreement = 0.2;  // of both turns, by the way
constexpr int kPhases = 4;

double end_of(int phase) noexcept {
  return kRest + (phase + 1) * kPhase;
}
constexpr double kAllOver = kRest + kPhases * kPhase + kRising;

Request hold_loosely(int axis) {
  const std::string to = direction_word(axis);
  return {
      {.kind = Order::Kind::kHold, .direction = Vector3::Unit(axis)},
      "Hold the handle loosely, let it go along: a small force to the side " + to + ", then back."};
}

}  // namespace

ForceSignStep::ForceSignStep(int axis)
    : Step(std::string("force ") + direction_word(axis), hold_loosely(axis)), axis_(axis) {}

Demand ForceSignStep::tick(const Seen& seen) noexcept {
  watch_.look(seen);
  const double time = watch_.time();
  double share = rising(time, kRest, kRest + kRising);
  for (int phase = 0; phase < kPhases; ++phase) {
    const double end = end_of(phase);
    if (time > end - kMeasured && time <= end) add(places_[static_cast<std::size_t>(phase)], seen);
    const double sign = phase % 2 == 0 ? -1.0 : 1.0;
    if (phase + 1 < kPhases) share += 2.0 * sign * rising(time, end, end + kTurning);
  }
  share += rising(time, end_of(kPhases - 1), kAllOver);
  return {kForce * share * Vector3::Unit(axis_)};
}

void ForceSignStep::add(Place& place, const Seen& seen) const noexcept {
  if (!seen.tip.allFinite()) return;
  place.sum += seen.tip;
  place.shown += seen.shown[axis_];
  ++place.count;
}

bool ForceSignStep::over() const noexcept {
  return watch_.trouble() != nullptr || watch_.time() >= kAllOver;
}

Judgement ForceSignStep::judge(Measured&) const {
  if (watch_.trouble() != nullptr) return {false, watch_.trouble()};
  std::array<Vector3, kPhases> mean;
  double shown = 0.0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place& place = places_[i];
    if (place.count == 0) return {false, "the device has no readings"};
    mean[i] = place.sum / place.count;
    shown += (i % 2 == 0 ? 0.25 : -0.25) * place.shown / place.count;
  }
  // Half the way between both forces, twice; what a hand drifts evenly is in neither.
  const Vector3 first = 0.25 * (mean[0] - 2.0 * mean[1] + mean[2]);
  const Vector3 second = 0.25 * (2.0 * mean[2] - mean[1] - mean[3]);
  const Vector3 way = 0.5 * (first + second);
  const std::string wanted = axis_word(Vector3::Unit(axis_));
  if (shown < 0.5 * kForce) {
    return {false, "the safety filter showed " + in_unit(shown, "N") + " of 0.2 N; run it again"};
  }
  if (way.cwiseAbs().maxCoeff() < kLeastWay) {
    return {false, "a force along " + wanted +
                       " did not move the handle; hold it loosely, and see that its motors are on"};
  }
  if ((first - second).norm() > kAgreement * way.norm() || !along_an_axis(way)) {
    return {false, "a force along " + wanted +
                       " and the way of the handle do not agree; hold it loosely and quietly, and "
                       "run it again"};
  }
  const std::string found = axis_word(way);
  const std::string words = "a force along " + wanted + " moved the handle along " + found +
                            " by " + in_unit(1e3 * way.cwiseAbs().maxCoeff(), "mm");
  if (found == wanted) return {true, words};
  const bool reversed = found[1] == wanted[1];
  return {false, words + (reversed ? ": the force is reversed" : ": forces are swapped") +
                     "; do not use this device before its driver is corrected"};
}

RampStep::RampStep(double limit)
    : Step("ramp", {{.kind = Order::Kind::kHold, .direction = Vector3::UnitY()},
                    "Hold the handle firmly: it is pushed up with a force that grows to " +
                        in_unit(limit, "N") + " in 4 s."}),
      limit_(limit) {}

Demand RampStep::tick(const Seen& seen) noexcept {
  watch_.look(seen);
  shown_ = std::max(shown_, seen.shown.y());
  const double share = rising(watch_.time(), 0.0, kRise) -
                       rising(watch_.time(), kRise + kHold, kRise + kHold + kFall);
  return {limit_ * share * Vector3::UnitY()};
}

bool RampStep::over() const noexcept {
  return watch_.trouble() != nullptr || watch_.time() >= kRise + kHold + kFall;
}

Judgement RampStep::judge(Measured& measured) const {
  constexpr double kEnough = 0.95;
  measured.max_force = std::min(shown_, limit_);
  if (watch_.trouble() != nullptr) {
    return {false, watch_.trouble() + std::string(", at ") + in_unit(shown_, "N")};
  }
  const std::string words = in_unit(shown_, "N") + " of " + in_unit(limit_, "N");
  if (shown_ < kEnough * limit_) {
    return {false, words + ": let the motors cool down, or lower bridge.max_force"};
  }
  return {true, words};
}

namespace {

constexpr double kGrow = 1.0;      // time in which the force grows [s]
constexpr double kFeel = 1.0;      // and for which it is felt before a link is cut [s]
constexpr double kNothing = 1e-3;  // that counts as no force [N]

Request stop_request(StopStep::Event event, int clutch) {
  switch (event) {
    case StopStep::Event::kButton:
      return {{.kind = Order::Kind::kStop, .button = clutch},
              "Hold the handle. Once you feel a force upwards, press the clutch button, or the "
              "device's own button that turns its force off."};
    case StopStep::Event::kLink:
      return {{.kind = Order::Kind::kHold},
              "Hold the handle: a force upwards ends as if the server were killed."};
    case StopStep::Event::kCable:
      break;
  }
  return {
      {.kind = Order::Kind::kUnplug},
      "Hold the handle. Once you feel a force upwards, pull the device's USB or network cable."};
}

const char* stop_name(StopStep::Event event) {
  switch (event) {
    case StopStep::Event::kButton:
      return "stop by button";
    case StopStep::Event::kLink:
      return "stop without server";
    case StopStep::Event::kCable:
      break;
  }
  return "stop by cable";
}

}  // namespace

StopStep::StopStep(Event event, int clutch)
    : Step(stop_name(event), stop_request(event, clutch)), event_(event), clutch_(clutch) {}

// What is waited for is no trouble.
Demand StopStep::tick(const Seen& seen) noexcept {
  const bool happened = since_.has_value();
  if (happened) *since_ += seen.elapsed;
  if (!happened && felt_ && happens(seen)) since_ = 0.0;
  if (!since_) watch_.look(seen);
  felt_ = felt_ || seen.shown.norm() > 0.9 * kForce;
  if (felt_) felt_for_ += seen.elapsed;
  gone_ = since_ && seen.shown.norm() < kNothing;
  const double share = rising(watch_.time(), 0.0, kGrow);
  return {.force = kForce * share * Vector3::UnitY(),
          .linked = event_ != Event::kLink || felt_for_ < kFeel};
}

bool StopStep::happens(const Seen& seen) const noexcept {
  const bool lost = !seen.tip.allFinite() || seen.device.lost || seen.device.failed;
  switch (event_) {
    case Event::kButton:
      return !seen.device.ready || (clutch_ >= 0 && (seen.buttons >> clutch_ & 1u) != 0);
    case Event::kLink:
      return felt_for_ >= kFeel;
    case Event::kCable:
      break;
  }
  return lost || !seen.device.ready;
}

bool StopStep::over() const noexcept {
  if (since_) return gone_ || *since_ >= kLongest;
  return watch_.trouble() != nullptr || watch_.time() >= kPatience;
}

Judgement StopStep::judge(Measured& measured) const {
  if (!since_ && watch_.trouble() != nullptr) return {false, watch_.trouble()};
  if (!felt_) return {false, "the safety filter showed no force; run it again"};
  if (!since_) return {false, "nothing happened within 60 s; run it again"};
  if (!gone_) {
    return {false, "a force was left after 0.1 s; do not use this device"};
  }
  Measured::Quantity Measured::*const quantity = event_ == Event::kButton ? &Measured::stop_button
                                                 : event_ == Event::kLink ? &Measured::stop_link
                                                                          : &Measured::stop_cable;
  measured.*quantity = *since_;
  return {true, "no force is sent after " + in_unit(1e3 * *since_, "ms")};
}

}  // namespace irdm::commission
