#pragma once

#include <cstdint>
#include <optional>

namespace irdm {

/// When a person who feels nothing should be told why: after so much time within sessions, however
/// many of them, without a stylus being armed. Pure.
class ArmingPatience {
 public:
  static constexpr std::int64_t kPatienceNs = 5'000'000'000;

  /// Within a session. True when it is to be told; then not again for as long.
  /// @param now_ns monotonic  @param armed every stylus is
  bool lost(std::int64_t now_ns, bool armed) noexcept {
    if (last_ns_ && !armed) unarmed_ns_ += now_ns - *last_ns_;
    if (armed) unarmed_ns_ = 0;
    last_ns_ = now_ns;
    if (unarmed_ns_ < kPatienceNs) return false;
    unarmed_ns_ = 0;
    return true;
  }
  /// The session is over: what follows until the next one does not count.
  void pause() noexcept { last_ns_.reset(); }

 private:
  std::optional<std::int64_t> last_ns_;
  std::int64_t unarmed_ns_ = 0;
};

}  // namespace irdm
