#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "simulation/step/step_record.hpp"

namespace irdm {

/// The forces on all styluses in the last steps, without a gap: a display that comes by less often
/// than the force changes still sees all of it. Pure; no memory of its own is taken.
class ForceTrail {
 public:
  static constexpr int kLength = 128;

  /// Takes in a step. One that does not follow the last one begins anew.
  void follow(const StepRecord& record) noexcept {
    if (count_ > 0 && record.force_step != newest_ + 1) count_ = 0;
    newest_ = record.force_step;
    count_ = std::min(count_ + 1, kLength);
    auto& forces = forces_[slot(newest_)];
    for (std::size_t s = 0; s < forces.size(); ++s) {
      forces[s] = record.stylus[s].force.cast<float>();
    }
  }

  /// How many steps it holds, 0 to kLength; the newest of them is step newest().
  int count() const noexcept { return count_; }
  std::uint64_t newest() const noexcept { return newest_; }
  /// Force on a stylus [N], W, `back` steps before the newest, 0 <= back < count().
  const Eigen::Vector3f& force(int back, int stylus) const noexcept {
    return forces_[slot(newest_ - static_cast<std::uint64_t>(back))]
                  [static_cast<std::size_t>(stylus)];
  }

 private:
  static std::size_t slot(std::uint64_t step) noexcept { return step % kLength; }

  std::array<std::array<Eigen::Vector3f, kMaxStyluses>, kLength> forces_;
  std::uint64_t newest_ = 0;
  int count_ = 0;
};

}  // namespace irdm
