#pragma once

#include <algorithm>
#include <cstdint>

namespace irdm {

/// How often contact models are made: each step, or each second, fourth or eighth while steps take
/// longer than dt. A second with more than kTooMany of them halves it, kGood seconds in a row with
/// fewer than kFew double it. Deadlines that were missed since nobody woke the thread do not count:
/// fewer models would not help. A step that is made up for has no time for a model, but a server
/// that is always behind must not fall silent: each fourth of them has one all the same. Pure,
/// real-time safe.
class PredictionThrottle {
 public:
  static constexpr double kTooMany = 0.01;  ///< of the steps
  static constexpr double kFew = 0.001;     ///< the same
  static constexpr int kGood = 5;           ///< [s]
  static constexpr int kRarest = 8;         ///< [steps]
  static constexpr int kRarestBehind = 4;   ///< the same, beyond the period, while behind

  /// After each second. @param steps made in it  @param overlong of them that took longer than dt
  void update(std::uint64_t steps, std::uint64_t overlong) noexcept {
    const auto all = static_cast<double>(steps);
    const auto late = static_cast<double>(overlong);
    good_ = late < kFew * all ? good_ + 1 : 0;
    if (late > kTooMany * all && period_ < kRarest) period_ *= 2;
    if (good_ < kGood) return;
    good_ = 0;
    if (period_ > 1) period_ /= 2;
  }
  /// After each step: whether models are made now.
  /// @param behind more steps are to follow at once
  bool due(bool behind) noexcept {
    ++since_;
    if (since_ < (behind ? std::max(period_, kRarestBehind) : period_)) return false;
    since_ = 0;
    return true;
  }
  /// From one to the next [steps].
  int period() const noexcept { return period_; }

 private:
  int period_ = 1;
  int good_ = 0;
  int since_ = 0;  ///< steps since the last models
};

}  // namespace irdm
