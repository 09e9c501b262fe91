#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/contact/contact_model.hpp"
#include "common/geometry.hpp"

namespace irdm {

/// What one stylus did in one step, where its bridge solves the contact.
struct AppliedForce {
  Vector3 force = Vector3::Zero();  ///< on the object [N], W
  Vector3 tip = Vector3::Zero();    ///< at the end of the step [m], W
  Vector3 arm = Vector3::Zero();    ///< from the centre of mass to where it acted [m], B
};

/// No device shows more [N], and no hand is taken to push harder.
inline constexpr double kMostAppliedForce = 40.0;

/// A force [N], no larger than `most`, whatever was found or told.
inline Vector3 bounded_force(const Vector3& force, double most = kMostAppliedForce) noexcept {
  const double norm = force.norm();
  return norm > most ? Vector3(most / norm * force) : force;
}

/// The last steps of such a stylus: each is told several times, so that what is lost on the way
/// comes with the next.
struct AppliedForces {
  static constexpr int kSteps = 16;

  std::uint64_t step = 0;                 ///< the newest
  std::uint64_t base = 0;                 ///< step of the contact model that the newest rests on
  int count = 0;                          ///< how many there are, 0 to kSteps, at most step + 1
  std::array<AppliedForce, kSteps> past;  ///< past[i] of step - i; the first `count`
};

/// What a bridge has told of the last steps of a stylus, put together from messages that overlap.
class AppliedHistory {
 public:
  static constexpr std::uint64_t kKept = 64;  ///< [steps]

  /// @param session of the bridge, as StylusInput::session
  explicit AppliedHistory(std::uint64_t session = 0) : session_(session) {}
  std::uint64_t session() const noexcept { return session_; }

  void take(const AppliedForces& applied) noexcept {
    for (int i = applied.count - 1; i >= 0; --i) {
      const std::uint64_t step = applied.step - static_cast<std::uint64_t>(i);
      Entry& entry = entries_[step % kKept];
      if (entry.step != kNoStep && entry.step > step) continue;
      const std::uint64_t base = entry.step == step ? entry.base : applied.base;
      entry = {step, base, applied.past[static_cast<std::size_t>(i)]};
    }
    if (applied.count == 0) return;
    if (newest_ == kNoStep || applied.step > newest_) newest_ = applied.step;
    base_ = std::max(base_, applied.base);
  }

  /// The newest step that anything is known of; kNoStep: none.
  std::uint64_t newest() const noexcept { return newest_; }
  /// The newest contact model that anything of it rests on, by its step.
  std::uint64_t base() const noexcept { return base_; }
  /// The contact model that a step rests on which find() knows, by its step.
  std::uint64_t base_of(std::uint64_t step) const noexcept { return entries_[step % kKept].base; }
  /// What was done in a step; null when it is not known, or not any more.
  const AppliedForce* find(std::uint64_t step) const noexcept {
    const Entry& entry = entries_[step % kKept];
    return entry.step == step ? &entry.applied : nullptr;
  }

 private:
  struct Entry {
    std::uint64_t step = kNoStep;
    std::uint64_t base = 0;
    AppliedForce applied;
  };
  std::array<Entry, kKept> entries_;
  std::uint64_t newest_ = kNoStep;
  std::uint64_t base_ = 0;
  std::uint64_t session_;
};

}  // namespace irdm
