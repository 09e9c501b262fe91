#pragma once

#include <array>
#include <cstddef>

#include "common/geometry.hpp"

namespace irdm {

/// The way of a stylus by its own samples, and how far along it the tips have come that its bridge
/// told with its forces. Work counts along this way only: a tip that is told elsewhere moves
/// nothing, and each part of the way counts once. Pure, real-time safe.
class SamplePath {
 public:
  /// Samples between the last tip and the newest sample; older ones are skipped.
  static constexpr std::size_t kKept = 64;
  /// Of two places that are as near to a told tip but for this, the earlier one counts [m].
  static constexpr double kAsNear = 5e-5;

  /// Forgets the way; it begins anew at `tip` [m], W.
  void begin(const Vector3& tip) noexcept {
    at_ = tip;
    count_ = 0;
  }
  /// The newest sample of a step [m], W.
  void add(const Vector3& tip) noexcept;
  /// Goes on to the place of the way that is nearest to a told tip, and returns it [m], W.
  /// @param longest way to go [m]
  const Vector3& follow(const Vector3& told, double longest) noexcept;
  /// Returns where follow() would go without a bound.
  Vector3 ahead(const Vector3& told) const noexcept { return nearest(told).point; }

 private:
  /// A place on the way to sample `next`.
  struct Place {
    Vector3 point;
    std::size_t next = 0;
  };
  const Vector3& sample(std::size_t i) const noexcept { return samples_[(first_ + i) % kKept]; }
  void drop_first() noexcept {
    first_ = (first_ + 1) % kKept;
    --count_;
  }
  Place nearest_of_part(std::size_t i, const Vector3& told) const noexcept;
  Place nearest(const Vector3& told) const noexcept;

  Vector3 at_ = Vector3::Zero();  ///< how far it has come
  std::size_t first_ = 0;         ///< of the samples after it
  std::size_t count_ = 0;
  std::array<Vector3, kKept> samples_;
};

}  // namespace irdm
