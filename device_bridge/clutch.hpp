#pragma once

#include <cstdint>
#include <optional>

#include "common/geometry.hpp"

namespace irdm {

/// Takes a device out of W and puts it back in another place. While its button is down the device
/// moves freely and the tip in W stays; when it is up again the tip goes on from there, by an
/// offset that stays. The force fades out and in, so that the hand feels no jump. The orientation
/// of the stylus is never taken out: it always points in W as the hand holds it. Pure.
class Clutch {
 public:
  /// In which the force goes from all to nothing or back, linearly [ns].
  static constexpr std::int64_t kFadeNs = 50'000'000;

  /// The tip in W [m].
  /// @param tip where the workspace puts the tip, without any offset [m], W
  /// @param down the clutch button
  Vector3 move(const Vector3& tip, bool down) noexcept;

  /// The share of the force to show now, 0 to 1. Real-time safe.
  /// @param now_ns any clock that does not decrease
  double gain(std::int64_t now_ns) noexcept;

 private:
  bool down_ = false;
  Vector3 held_ = Vector3::Zero();    ///< the tip while the button is down [m], W
  Vector3 offset_ = Vector3::Zero();  ///< [m], W
  double gain_ = 1.0;
  std::optional<std::int64_t> last_ns_;
};

}  // namespace irdm
