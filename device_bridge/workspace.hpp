#pragma once

#include <cstdint>
#include <optional>

#include "common/geometry.hpp"
#include "common/stylus.hpp"
#include "device_bridge/stylus_script.hpp"

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

/// Which button of a device does what: numbers of bits in its button field, 0 to 31; kNone: none.
struct ButtonMap {
  static constexpr int kNone = -1;
  int grab = 0;    ///< takes hold of the object
  int clutch = 1;  ///< takes the device out of W; stays at the bridge
  int reset = 2;   ///< puts every object back to the start

  bool clutched(std::uint32_t device_buttons) const noexcept {
    return down(device_buttons, clutch);
  }
  /// What the server is told: StylusSample::buttons.
  std::uint32_t to_wire(std::uint32_t device_buttons) const noexcept {
    return (down(device_buttons, grab) ? kGrabButton : 0u) |
           (down(device_buttons, reset) ? kResetButton : 0u);
  }

 private:
  static bool down(std::uint32_t buttons, int bit) noexcept {
    return bit != kNone && (buttons >> bit & 1u) != 0;
  }
};

/// Where the frame D of a device lies in W: p_W = position + scale rotation p_D. Pure.
///
/// With v_W = scale R v_D and f_D = force_scale R^T f_W, what the device does to the hand is
/// f_D . v_D = (force_scale / scale) f_W . v_W: a fixed positive multiple of what happens in W.
/// Turns have no scale, w_W = R w_D, so torques have this multiple: t_D = (force_scale / scale) R^T
/// t_W. Any positive pair keeps a passive world passive at the device; only its stiffness in the
/// hand changes, by force_scale times scale, and with it how soon a delayed loop becomes unstable.
struct Workspace {
  Vector3 position = Vector3::Zero();            ///< of D's origin [m], W
  Quaternion rotation = Quaternion::Identity();  ///< D to W, norm 1
  double scale = 1.0;                            ///< length in W per length in D, > 0
  double force_scale = 1.0;                      ///< force at the device per force in W, > 0

  /// A point of D [m] in W.
  Vector3 to_world(const Vector3& point_D) const noexcept;
  /// A pose in D in W; buttons stay.
  StylusPose to_world(const StylusPose& pose_D) const noexcept;
  /// A force in W as the device shows it [N], D.
  Vector3 to_device(const Vector3& force_W) const noexcept;
  /// A torque in W as the device shows it [N m], D.
  Vector3 torque_to_device(const Vector3& torque_W) const noexcept;
  /// The force in W that the device shows as this one [N], D.
  Vector3 force_to_world(const Vector3& force_D) const noexcept;
  /// A direction in W, in D.
  Vector3 direction_to_device(const Vector3& direction_W) const noexcept {
    return rotation.conjugate() * direction_W;
  }
};

}  // namespace irdm
