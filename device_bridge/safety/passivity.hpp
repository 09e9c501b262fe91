#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/motion/wrench.hpp"
#include "device_bridge/safety/guards.hpp"

namespace irdm {

/// Work between the world and the poses of the stylus that its forces and torques answer. A force
/// that is late answers a pose of before, and the world's own account is closed by that pose: a
/// passive world gives back at most what it took there, whatever the delay makes of it at the
/// device. What it gives beyond is from somewhere else: another hand, a weight. Pure, real-time
/// safe.
class WorldWork {
 public:
  static constexpr double kMost = 0.2;  ///< energy that is remembered as taken, at most [J]
  /// Between two poses that are answered; after a longer one nothing is known of the contact [ns].
  static constexpr std::int64_t kLongest = 50'000'000;

  /// Once a tick: the stylus was here, its tip in m, D. Times go forward.
  void observe(std::int64_t now_ns, const Vector3& tip,
               const Quaternion& orientation = Quaternion::Identity()) noexcept;

  /// A newer force and torque on the stylus, D, that answer the pose of then. Returns what the
  /// world gave beyond all that it took [J], >= 0. One that is older than the last, or than what is
  /// remembered, counts from the next one on.
  double answer(std::int64_t time_ns, const Wrench& wrench) noexcept;

 private:
  struct Pose {
    std::int64_t time_ns = 0;
    Vector3 tip = Vector3::Zero();
    Quaternion orientation = Quaternion::Identity();
  };
  static constexpr std::size_t kKept = 128;

  const Pose* at(std::int64_t time_ns) const noexcept;

  std::array<Pose, kKept> poses_{};
  std::size_t count_ = 0;  ///< observed so far
  Pose answered_;          ///< the last one
  bool any_ = false;       ///< answered_ means something
  double taken_ = 0.0;     ///< 0 to kMost [J]
};

struct PassivityLimits {
  double damping = 6.0;    ///< at most [N s/m]; of a turn times kLever^2 [N m s/rad]
  double most = 0.2;       ///< energy that is remembered as taken in, at most [J]
  double least = -0.05;    ///< the same, given out in excess [J]
  double credit = 1e-3;    ///< energy that a force of now may give in excess [J]
  double fade = 5e-3;      ///< given in excess, at which a force of now has faded to nothing [J]
  double forgiven = 0.02;  ///< of the excess, while there is no contact [W]
};

/// Time-domain passivity at the device's port. The observer adds up what the device takes from the
/// hand, E = -sum (f . dx + torque . dtheta) with what was really shown, in one account; a device
/// that only gives back what it took keeps E >= 0. Where the coming tick would take E below zero,
/// the controller asks for the damping that makes up for it, within its bound. What an object took
/// in and lost to its own damping is forgotten above `most`, else the observer would be blind after
/// a while. Bounded damping does not hold a force that the device shows in part only, or later than
/// the object gets it; what such a force would give beyond a little is withheld, and when more was
/// given, all of it fades, until the contact ends. Pure, real-time safe.
class Passivity {
 public:
  explicit Passivity(const PassivityLimits& limits) : limits_(limits) {}

  /// The hand moved by this while `shown` was [m, rad], D.
  void observe(const Twist& displacement, const Wrench& shown) noexcept;
  /// There was no contact in this time [s]: what was given in excess is forgiven.
  void forgive(double elapsed) noexcept;

  /// Damping for the coming tick [N s/m], 0 to the limit; that of turns is kLever^2 times as much.
  /// @param wrench that is about to be shown, D
  /// @param velocity of the hand, D
  /// @param tick how long it will be shown [s]
  double damping(const Wrench& wrench, const Twist& velocity, double tick) const noexcept;

  /// The world gave this of its own, by another hand or a weight, and the device may [J], >= 0.
  void grant(double energy) noexcept;
  /// By the account of both ends the device may give no more than this now [J]. What is not a
  /// number bounds nothing.
  void bound(double energy) noexcept;

  /// What may be shown of a force that answers the tip as it is now [N], D: no more along the way
  /// of the coming tick than gives half of what is left above -credit. That way goes on from the
  /// last two by its velocity and its acceleration. Below zero all of the force fades.
  Vector3 withheld(const Vector3& force) const noexcept;
  /// What is left of the force by that fade, 0 to 1.
  double share() const noexcept { return std::clamp(1.0 + energy() / limits_.fade, 0.0, 1.0); }

  /// The smaller of both accounts [J], least to most.
  double energy() const noexcept { return std::min(energy_, bound_); }

 private:
  PassivityLimits limits_;
  double energy_ = 0.0;
  double bound_ = limits_.most;       ///< by the account of both ends [J]
  Vector3 last_ = Vector3::Zero();    ///< displacement of the tip in the last tick [m]
  Vector3 before_ = Vector3::Zero();  ///< and in the one before [m]
};

}  // namespace irdm
