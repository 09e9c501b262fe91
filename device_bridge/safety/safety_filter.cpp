#include "device_bridge/safety/safety_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/realtime/clock.hpp"

namespace irdm {
namespace {

// Later less earlier [ns], for any two times; no more than what counts as for ever.
constexpr std::int64_t kForEver = std::numeric_limits<std::int64_t>::max() / 4;
std::int64_t difference(std::int64_t later, std::int64_t earlier) noexcept {
  const double rough = static_cast<double>(later) - static_cast<double>(earlier);
  if (std::abs(rough) >= static_cast<double>(kForEver)) return rough > 0 ? kForEver : -kForEver;
  return later - earlier;
}

// Both are needed: the stable norm of (0, NaN, 0) is zero.
bool finite_magnitude(const Vector3& v) noexcept {
  return v.allFinite() && std::isfinite(v.stableNorm());
}

// At most so long; what is not finite becomes zero.
Vector3 cut_off(const Vector3& vector, double most) noexcept {
  if (!finite_magnitude(vector)) return Vector3::Zero();
  const double magnitude = vector.stableNorm();
  return magnitude > most ? Vector3(most / magnitude * vector) : vector;
}

// The limits as the guards leave them. One of the magnitude that becomes lower takes its share of
// the falling rate.
RateLimits rate_limits(RateLimits rate, double slew, Guards guards) noexcept {
  constexpr double kNone = 1e9;
  rate.fall -= slew;
  if (!guards.on(Guard::kRiseLimit)) rate.rise = kNone;
  if (!guards.on(Guard::kFallLimit)) rate.fall = kNone;
  return rate;
}

// Of a wrench of which an unknown share was shown: it took nothing for sure, and gave as much as in
// full.
Wrench giving(const Wrench& wrench, const Twist& displacement) noexcept {
  Wrench given;
  if (wrench.force.dot(displacement.linear) > 0.0) given.force = wrench.force;
  if (wrench.torque.dot(displacement.angular) > 0.0) given.torque = wrench.torque;
  return given;
}

constexpr double kTorqueSlew = kLever * ThermalLimits{}.slew;

// A device that renders torque has an orientation that counts.
ReadingLimits reading_limits(const FilterLimits& limits) noexcept {
  ReadingLimits reading = limits.reading;
  reading.turns = limits.max_torque > 0.0;
  return reading;
}

}  // namespace

SafetyFilter::SafetyFilter(const FilterLimits& limits, Guards guards)
    : limits_(limits),
      guards_(guards),
      reading_(reading_limits(limits), guards),
      arming_(limits.arming, guards),
      passivity_(limits.passivity),
      oscillation_(limits.oscillation),
      thermal_({.peak = limits.max_force, .continuous = limits.continuous_force}),
      torque_thermal_({.peak = limits.max_torque,
                       .continuous = limits.continuous_torque,
                       .slew = kTorqueSlew}) {
  limits_.rate = rate_limits(limits.rate, ThermalLimits{}.slew, guards);
  limits_.torque_rate = rate_limits(limits.torque_rate, kTorqueSlew, guards);
}

void SafetyFilter::arm() noexcept {
  waits_ = state() == FilterState::kDisarmed && gate_.success_rate() < limits_.needed_success;
  if (!waits_) arming_.arm();
}

void SafetyFilter::disarm() noexcept {
  waits_ = false;
  oscillation_.reset();
  arming_.disarm();
}

void SafetyFilter::fail() noexcept {
  if (std::exchange(waits_, false)) arming_.arm();  // else the fault would be forgotten
  if (state() != FilterState::kDisarmed) ++counts_.faults;
  arming_.fail();
}

Wrench SafetyFilter::step(std::int64_t now_ns, const DeviceReading& reading,
                          const ForceDemand& demand) noexcept {
  const ReadingVerdict verdict = check(now_ns, reading);
  observe(now_ns, reading.saturated || reading.off);
  thermal_.heat(sent_.force.norm(), reading_.elapsed(), reading.motor_temperature);
  torque_thermal_.heat(sent_.torque.norm(), reading_.elapsed(), reading.motor_temperature);
  if (reading.off) forget_sent();
  accept(now_ns, demand);
  age_ = age(now_ns);
  const double fresh_share = fresh(now_ns);
  watch_link(fresh_share);
  const Wrench wrench = wanted();
  // Where no force is shown or asked for there is none to drop: a hand may be fast in free air.
  if (verdict == ReadingVerdict::kTrip && !(sent_.is_zero() && wrench.is_zero())) {
    ++counts_.trips;
    arming_.trip();
  }
  const double most = std::max(wrench.force.norm(), wrench.torque.norm() / kLever);
  const double share = arming_.step(reading_.elapsed(), fresh_share, most);
  sent_ = limited(damped({share * wrench.force, share * wrench.torque}, share));
  return sent_;
}

// Sanity of the reading and of the time.
ReadingVerdict SafetyFilter::check(std::int64_t now_ns, const DeviceReading& reading) noexcept {
  const ReadingVerdict verdict = reading.repeated
                                     ? reading_.repeat(now_ns)
                                     : reading_.look(now_ns, reading.tip, reading.orientation);
  counts_.readings = reading_.unused();
  if (verdict == ReadingVerdict::kFault) fail();
  return verdict;
}

// Motors that are off show nothing; when they are on again the force rises from there.
void SafetyFilter::forget_sent() noexcept {
  sent_ = Wrench{};
  arming_.trip();
}

// What the hand did against what was really sent.
void SafetyFilter::observe(std::int64_t now_ns, bool in_part) noexcept {
  const Twist& displacement = reading_.displacement();
  const Wrench shown = in_part ? giving(sent_, displacement) : sent_;
  passivity_.observe(displacement, shown);
  if (held_.solved_here && held_.contact == ContactState::kFree) {
    passivity_.forgive(reading_.elapsed());
  }
  oscillation_.observe(-work(shown, displacement), reading_.elapsed(), age_, !sent_.is_zero());
  world_.observe(now_ns, reading_.tip(), reading_.orientation());
}

// The newest demand. One that is not used changes nothing: the one before stays, and grows old.
void SafetyFilter::accept(std::int64_t now_ns, const ForceDemand& demand) noexcept {
  if (!demand.linked) {
    if (!lost_since_ns_) lost_since_ns_ = now_ns;
    return;
  }
  if (!demand.any) return;
  const bool finite = finite_magnitude(demand.force) && finite_magnitude(demand.torque) &&
                      demand.normal.allFinite();
  const bool ordered = demand.sample_time_ns <= now_ns &&
                       (!held_.any || demand.sample_time_ns >= held_.sample_time_ns);
  if ((!finite && guards_.on(Guard::kFrameFinite)) ||
      (!ordered && guards_.on(Guard::kFrameOrder))) {
    ++counts_.demands;
    return;
  }
  held_ = demand;
  grant(demand);
  if (beyond_horizon(now_ns, demand) <= 0) in_time_ = demand;
  lost_since_ns_.reset();
}

// What the world gave of its own the device may give.
void SafetyFilter::grant(const ForceDemand& demand) noexcept {
  const std::int64_t time_ns = demand.solved_here ? demand.solved_ns : demand.sample_time_ns;
  const double energy = world_.answer(time_ns, {demand.force, demand.torque});
  passivity_.grant(energy);
  passivity_.bound(demand.solved_here ? demand.energy : limits_.passivity.most);
  oscillation_.grant(energy);
}

// For how long a demand has not been good any more [ns].
std::int64_t SafetyFilter::beyond_horizon(std::int64_t now_ns,
                                          const ForceDemand& demand) const noexcept {
  return difference(now_ns, demand.sample_time_ns) -
         std::clamp(demand.horizon_ns, std::int64_t{0}, limits_.max_horizon_ns);
}

// How far the force lags behind the tip that it answers [s].
double SafetyFilter::age(std::int64_t now_ns) const noexcept {
  if (!held_.any || held_.solved_here) return 0.0;
  return kNanosecond * static_cast<double>(difference(now_ns, held_.sample_time_ns));
}

// The share that is left of a force. One that came too late says what it is, and not for how long.
double SafetyFilter::fresh(std::int64_t now_ns) const noexcept {
  if (!held_.any) return 0.0;
  std::int64_t over_ns = in_time_.any ? beyond_horizon(now_ns, in_time_) : kForEver;
  if (!guards_.on(Guard::kAge)) over_ns = 0;
  if (lost_since_ns_ && guards_.on(Guard::kLink)) {
    over_ns = std::max(over_ns, difference(now_ns, *lost_since_ns_));
  }
  return std::clamp(1.0 - static_cast<double>(over_ns) / static_cast<double>(limits_.fade_ns), 0.0,
                    1.0);
}

void SafetyFilter::watch_link(double fresh) noexcept {
  gate_.tick(fresh == 1.0);
  if (waits_ && gate_.success_rate() >= limits_.needed_success) {
    waits_ = false;
    arming_.arm();
  }
}

// Outward only, unless held.
Wrench SafetyFilter::wanted() const noexcept {
  if (held_.contact == ContactState::kTouching && guards_.on(Guard::kPushOnly) &&
      held_.force.dot(held_.normal) < 0.0) {
    return {};
  }
  const double gain = guards_.on(Guard::kOscillation) ? oscillation_.gain() : 1.0;
  const Wrench asked{held_.force, held_.torque};
  const Wrench wrench = guards_.on(Guard::kForceLimit) ? shortened(asked) : asked;
  return {gain * wrench.force, gain * wrench.torque};
}

// What passivity asks for, and damping while the force fades. It fades as well. At a device that
// renders torque a tool pulls and turns without a contact of its tip.
Wrench SafetyFilter::damped(const Wrench& wrench, double share) const noexcept {
  const bool tool = limits_.max_torque > 0.0 && !wrench.is_zero();
  const bool asked = held_.contact != ContactState::kFree || tool;
  if (share == 0.0 || !asked) return wrench;
  const Twist& velocity = reading_.velocity();
  double damping = 0.0;
  if (guards_.on(Guard::kPassivity)) {
    damping = passivity_.damping(wrench, velocity, reading_.elapsed());
  }
  if (arming_.state() == FilterState::kFading && guards_.on(Guard::kFadeDamping)) {
    damping = std::max(damping, limits_.fade_damping);
  }
  Wrench damped{wrench.force - share * damping * velocity.linear,
                wrench.torque - share * damping * kLever * kLever * velocity.angular};
  if (held_.solved_here && guards_.on(Guard::kPassivity)) {
    damped.force = passivity_.withheld(damped.force);
  }
  return damped;
}

Wrench SafetyFilter::limited(const Wrench& wrench) const noexcept {
  const bool on = guards_.on(Guard::kForceLimit);
  const Wrench aim = on ? shortened(wrench) : wrench;
  const double elapsed = reading_.elapsed();
  const Wrench reached{limit_rate(sent_.force, aim.force, limits_.rate, elapsed),
                       limit_rate(sent_.torque, aim.torque, limits_.torque_rate, elapsed)};
  return on ? shortened(reached) : reached;
}

// At most what the motors bear now.
Wrench SafetyFilter::shortened(const Wrench& wrench) const noexcept {
  const bool thermal = guards_.on(Guard::kThermal);
  return {cut_off(wrench.force, thermal ? thermal_.limit() : limits_.max_force),
          cut_off(wrench.torque, thermal ? torque_thermal_.limit() : limits_.max_torque)};
}

}  // namespace irdm
