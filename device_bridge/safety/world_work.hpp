#pragma once

#include <array>
#include <cstdint>

#include "common/geometry.hpp"

namespace irdm {

/// Work between the world and the tips that its forces answer. A force that is late answers a tip
/// of before, and the world's own account is closed by that tip: a passive world gives back at most
/// what it took there, whatever the delay makes of it at the device. What it gives beyond is from
/// somewhere else: another hand, a weight. Pure, real-time safe.
class WorldWork {
 public:
  static constexpr double kMost = 0.2;  ///< energy that is remembered as taken, at most [J]
  /// Between two tips that are answered; after a longer one nothing is known of the contact [ns].
  static constexpr std::int64_t kLongest = 50'000'000;

  /// Once a tick: the tip was here [m], D. Times go forward.
  void observe(std::int64_t now_ns, const Vector3& tip) noexcept;

  /// A newer force on the stylus [N], D, that answers the tip of then. Returns what the world gave
  /// beyond all that it took [J], >= 0. One that is older than the last, or than what is
  /// remembered, counts from the next one on.
  double answer(std::int64_t time_ns, const Vector3& force) noexcept;

 private:
  struct Tip {
    std::int64_t time_ns = 0;
    Vector3 place = Vector3::Zero();
  };
  static constexpr std::size_t kKept = 128;

  const Tip* at(std::int64_t time_ns) const noexcept;

  std::array<Tip, kKept> tips_{};
  std::size_t count_ = 0;  ///< observed so far
  Tip answered_;           ///< the last one
  bool any_ = false;       ///< answered_ means something
  double taken_ = 0.0;     ///< 0 to kMost [J]
};

}  // namespace irdm
