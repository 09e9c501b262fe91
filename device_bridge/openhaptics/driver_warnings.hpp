#pragma once

#include <array>
#include <cstdint>

namespace irdm::hd {

/// Warnings of a driver that a force or a speed was too much. It goes on by itself; the force is
/// dropped for a while, and for good when that does not help. Pure, real-time safe.
class DriverWarnings {
 public:
  static constexpr int kPauseTicks = 500;               ///< without force after a warning
  static constexpr std::size_t kMost = 3;               ///< so many pauses ...
  static constexpr std::uint64_t kOftenTicks = 10'000;  ///< ... begun in this time are too many

  /// Once a tick.
  void tick() noexcept {
    ++now_;
    if (pause_ > 0) --pause_;
  }
  /// A warning: a pause begins, or is prolonged. False: there were too many.
  [[nodiscard]] bool bearable() noexcept {
    const bool same = pause_ > 0;
    pause_ = kPauseTicks;
    if (same) return true;
    std::uint64_t& oldest = begun_[count_ % begun_.size()];
    const bool often = count_ >= begun_.size() && now_ - oldest <= kOftenTicks;
    oldest = now_;
    ++count_;
    return !often;
  }
  bool paused() const noexcept { return pause_ > 0; }

 private:
  std::uint64_t now_ = 0;                         ///< ticks so far
  std::array<std::uint64_t, kMost - 1> begun_{};  ///< when the last pauses began
  std::size_t count_ = 0;                         ///< of pauses
  int pause_ = 0;                                 ///< ticks that are left of it
};

}  // namespace irdm::hd
