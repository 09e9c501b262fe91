#pragma once

#include <algorithm>
#include <cstdint>

#include "common/realtime/clock.hpp"

namespace irdm {

/// So many of something in a second, and a burst when there were few before. Pure.
class TokenBucket {
 public:
  /// @param rate [1/s], > 0
  /// @param burst how many at once, >= 1
  TokenBucket(double rate, double burst) : rate_(rate), burst_(burst), left_(burst) {}

  /// Takes one; false when there is none left.
  /// @param now_ns monotonic
  bool take(std::int64_t now_ns) noexcept {
    if (now_ns > last_ns_) {
      const double elapsed = kNanosecond * static_cast<double>(now_ns - last_ns_);
      left_ = std::min(burst_, left_ + rate_ * elapsed);
      last_ns_ = now_ns;
    }
    if (left_ < 1.0) return false;
    left_ -= 1.0;
    return true;
  }

 private:
  double rate_;
  double burst_;
  double left_;
  std::int64_t last_ns_ = 0;
};

/// Lines of the log about what peers do wrong: 5 a second, 50 at once.
inline TokenBucket complaint_allowance() {
  return {5.0, 50.0};
}

}  // namespace irdm
