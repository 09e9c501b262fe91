#include "device_bridge/safety/oscillation_detector.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {

void OscillationDetector::observe(double work, double elapsed, double age, bool pushed) noexcept {
  time_ += elapsed;
  ages_ += age * elapsed;
  gain_ = std::min(1.0, gain_ * (1.0 + elapsed / limits_.recovery));
  if (balance_ < 0.0) balance_ *= std::max(0.0, 1.0 - elapsed / limits_.recovery);
  if (!std::isfinite(work)) return;
  balance_ = std::min(limits_.most, balance_ + work);
  if (age > 0.0 && balance_ <= -limits_.owed) cut();
  energy_ += work;
  high_ = std::max(high_, energy_);
  extreme_ = rising_ ? std::max(extreme_, energy_) : std::min(extreme_, energy_);
  if (cycling_ && active(energy_) && debt_ - energy_ >= limits().debt) cut();
  if (!turns(pushed)) return;
  rising_ = !rising_;
  if (rising_) pass_low();
  extreme_ = energy_;
}

void OscillationDetector::grant(double energy) noexcept {
  balance_ = std::min(limits_.most, balance_ + energy);
}

// From rising to falling, or the other way round; what was given until touch was lost is a low.
bool OscillationDetector::turns(bool pushed) const noexcept {
  const bool lost = !pushed && !rising_ && energy_ <= -limits_.swing;
  return lost || std::abs(energy_ - extreme_) >= limits_.swing;
}

// `extreme_` is the low, counted from the one before.
void OscillationDetector::pass_low() noexcept {
  cycling_ = time_ <= limits_.late.longest;
  if (!cycling_) debt_ = 0.0;
  if (extreme_ > 0.0 || active(extreme_)) debt_ = std::max(0.0, debt_ - extreme_);
  energy_ -= extreme_;
  high_ = energy_;
  time_ = 0.0;
  ages_ = 0.0;
}

// Of the cycle so far; without any age none is short enough.
OscillationLimits::Cycles OscillationDetector::limits() const noexcept {
  if (ages_ > limits_.fresh_age * time_) return limits_.late;
  return ages_ > 0.0 ? limits_.fresh : OscillationLimits::Cycles{};
}

// A cycle that ends with this low.
bool OscillationDetector::active(double low) const noexcept {
  return time_ <= limits().longest && -low >= limits_.active * high_;
}

// What comes after it is counted anew.
void OscillationDetector::cut() noexcept {
  gain_ = std::max(limits_.least, limits_.cut * gain_);
  balance_ = std::max(0.0, balance_);
  debt_ = 0.0;
  energy_ = 0.0;
  high_ = 0.0;
  extreme_ = 0.0;
}

}  // namespace irdm
