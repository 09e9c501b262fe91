#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/geometry.hpp"

namespace irdm {

/// The work of one hand whose bridge tells of its steps in any order: in step k the tip was at p_k,
/// and f_k acted until the next step that was told of, m. Of the way between them it has the share
/// of one step: f_k . (p_m - p_k) / (m - k). What is told later corrects what was counted before.
/// Pure, real-time safe.
class WorkLedger {
 public:
  /// Steps that are looked back at from the newest one.
  static constexpr std::uint64_t kKept = 64;

  void clear() noexcept {
    newest_ = 0;
    steps_.fill({});
  }
  /// Where the tip was in step k, which acts on nothing so far; between two steps that are known,
  /// what counts is the nearest place of the straight way between them. Returns what this adds to
  /// the work [J]. A step that is known, or from too long ago, stays as it is.
  /// @param k counted from 1  @param place [m], W
  double tell(std::uint64_t k, const Vector3& place) noexcept {
    if (k == 0 || k + kKept <= newest_ || known(k)) return 0.0;
    newest_ = std::max(newest_, k);
    const Step* const before = previous(k);
    const Step* const after = next(k);
    const double counted = before && after ? work(*before, *after) : 0.0;
    Step& step = steps_[k % kKept];
    step = {.number = k, .place = place};
    if (before && after) step.place = nearest(*before, *after, place);
    return (before ? work(*before, step) : 0.0) - counted;
  }
  /// What would act in step k adds so much to the work as it is known [J]. @param force [N], W
  double of(std::uint64_t k, const Vector3& force) const noexcept {
    const Step* const after = known(k) ? next(k) : nullptr;
    return after ? work(steps_[k % kKept], *after, force) : 0.0;
  }
  /// It acts; returns the same. @param force on the object [N], W
  double show(std::uint64_t k, const Vector3& force) noexcept {
    if (!known(k)) return 0.0;
    const double added = of(k, force) - of(k, steps_[k % kKept].force);
    steps_[k % kKept].force = force;
    return added;
  }

 private:
  struct Step {
    std::uint64_t number = 0;  ///< 0: none
    Vector3 place = Vector3::Zero();
    Vector3 force = Vector3::Zero();
  };

  bool known(std::uint64_t k) const noexcept { return k > 0 && steps_[k % kKept].number == k; }
  const Step* previous(std::uint64_t k) const noexcept {
    while (--k > 0 && k + kKept > newest_) {
      if (known(k)) return &steps_[k % kKept];
    }
    return nullptr;
  }
  const Step* next(std::uint64_t k) const noexcept {
    while (++k <= newest_) {
      if (known(k)) return &steps_[k % kKept];
    }
    return nullptr;
  }
  static double work(const Step& from, const Step& to, const Vector3& force) noexcept {
    return force.dot(to.place - from.place) / static_cast<double>(to.number - from.number);
  }
  static double work(const Step& from, const Step& to) noexcept {
    return work(from, to, from.force);
  }
  static Vector3 nearest(const Step& from, const Step& to, const Vector3& place) noexcept {
    const Vector3 way = to.place - from.place;
    const double square = way.squaredNorm();
    const double share = square > 0.0 ? (place - from.place).dot(way) / square : 0.0;
    return from.place + std::clamp(share, 0.0, 1.0) * way;
  }

  std::uint64_t newest_ = 0;
  std::array<Step, kKept> steps_;
};

}  // namespace irdm
