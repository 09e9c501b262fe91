#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace irdm::hd {

/// Warnings of a driver that a force or a speed was too much. It goes on by itself; the force is
/// dropped for a while, and for good when that does not help. A hand that is fast in free air has
/// no force to blame. Pure, real-time safe.
class DriverWarnings {
 public:
  static constexpr std::int64_t kPauseNs = 500'000'000;     ///< without force after a warning
  static constexpr std::size_t kMost = 3;                   ///< so many pauses ...
  static constexpr std::int64_t kOftenNs = 10'000'000'000;  ///< ... begun in this time are too many

  /// Once a tick. @param elapsed_ns since the last one
  void tick(std::int64_t elapsed_ns) noexcept {
    now_ += elapsed_ns;
    pause_ = std::max<std::int64_t>(pause_ - elapsed_ns, 0);
  }
  /// A warning: a pause begins, or is prolonged. False: there were too many.
  /// @param force_shown else it does not count
  [[nodiscard]] bool bearable(bool force_shown) noexcept {
    const bool same = pause_ > 0;
    pause_ = kPauseNs;
    if (same || !force_shown) return true;
    std::int64_t& oldest = begun_[count_ % begun_.size()];
    const bool often = count_ >= begun_.size() && now_ - oldest <= kOftenNs;
    oldest = now_;
    ++count_;
    return !often;
  }
  bool paused() const noexcept { return pause_ > 0; }

 private:
  std::int64_t now_ = 0;                         ///< since the first tick [ns]
  std::array<std::int64_t, kMost - 1> begun_{};  ///< when the last pauses that count began
  std::size_t count_ = 0;                        ///< of these
  std::int64_t pause_ = 0;                       ///< what is left of it [ns]
};

}  // namespace irdm::hd
