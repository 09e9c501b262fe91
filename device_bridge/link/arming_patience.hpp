#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace irdm {

/// When a person who feels nothing, or not for long, should be told why: after so much more time on
/// a bad link than on a good one, within sessions, however many of them. Pure.
class ArmingPatience {
 public:
  static constexpr std::int64_t kPatienceNs = 5'000'000'000;

  /// Within a session. True when it is to be told; then not again for as long.
  /// @param now_ns monotonic  @param good every stylus is armed, and its link good enough to arm
  bool lost(std::int64_t now_ns, bool good) noexcept {
    const std::int64_t elapsed_ns = last_ns_ ? now_ns - *last_ns_ : 0;
    last_ns_ = now_ns;
    bad_ns_ = good ? std::max<std::int64_t>(bad_ns_ - elapsed_ns, 0) : bad_ns_ + elapsed_ns;
    if (bad_ns_ < kPatienceNs) return false;
    bad_ns_ = 0;
    return true;
  }
  /// The session is over: what follows until the next one does not count.
  void pause() noexcept { last_ns_.reset(); }

 private:
  std::optional<std::int64_t> last_ns_;
  std::int64_t bad_ns_ = 0;
};

}  // namespace irdm
