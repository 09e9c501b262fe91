#pragma once

#include <bitset>
#include <cstddef>

namespace irdm {

/// How good the link is: the share of the last kWindow ticks for which the newest demand was young
/// enough. Ticks that were not yet made count as bad. Pure, real-time safe.
class LinkGate {
 public:
  static constexpr std::size_t kWindow = 100;
  static constexpr double kNeeded = 0.90;  ///< success rate to arm with

  /// @param in_time whether the newest demand was young enough in this tick
  void tick(bool in_time) noexcept {
    if (ticks_[next_]) --good_;
    if (in_time) ++good_;
    ticks_[next_] = in_time;
    next_ = (next_ + 1) % kWindow;
  }
  /// 0 to 1.
  double success_rate() const noexcept {
    return static_cast<double>(good_) / static_cast<double>(kWindow);
  }

 private:
  std::bitset<kWindow> ticks_;
  std::size_t next_ = 0;
  std::size_t good_ = 0;
};

}  // namespace irdm
