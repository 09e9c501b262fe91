#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/contact/applied_forces.hpp"
#include "common/contact/contact_model.hpp"

namespace irdm {

/// For how many steps a bridge is told how its contact goes on: as far as it is ahead of the
/// server, and kOverrun more. Becomes longer at once, and shorter after kPatience. Pure, real-time
/// safe.
class HorizonLength {
 public:
  /// For how long a bridge can go on when no newer model comes [s].
  static constexpr double kOverrun = 0.02;
  static constexpr double kLongest = 0.05;  ///< [s]
  static constexpr double kPatience = 1.0;  ///< [s]
  /// It is a multiple of that, since each other one is computed anew [steps].
  static constexpr int kUnit = 4;

  /// @param dt of a step [s]
  explicit HorizonLength(double dt) noexcept
      : dt_(dt),
        longest_(std::clamp(static_cast<int>(kLongest / dt + 1e-6), 1, kMaxHorizon)),
        steps_(longest_) {}

  /// In each step: what the bridge told of last.
  void follow(const AppliedHistory& history) noexcept {
    lead_ = history.newest() > history.base() ? history.newest() - history.base() : 0;
    lead_ = std::min<std::uint64_t>(lead_, kMaxHorizon);
    const double needed = static_cast<double>(lead_) + kOverrun / dt_;
    const int units = static_cast<int>(std::ceil(needed / kUnit - 1e-6));
    const int wanted = std::min(kUnit * units, longest_);
    too_long_ = wanted < steps_ ? too_long_ + 1 : 0;
    if (wanted > steps_ || too_long_ * dt_ >= kPatience) steps_ = wanted;
  }

  /// 1 to kMaxHorizon.
  int steps() const noexcept { return steps_; }
  /// Of the bridge, to the model that its newest force rests on [steps].
  std::uint64_t lead() const noexcept { return lead_; }

 private:
  double dt_;
  int longest_;
  int steps_;
  std::uint64_t lead_ = 0;
  int too_long_ = 0;  ///< steps since which it has been longer than it must be
};

}  // namespace irdm
