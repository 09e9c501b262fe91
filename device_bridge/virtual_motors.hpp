#pragma once

#include <limits>

#include "common/geometry.hpp"

namespace irdm {

/// What the motors of a device can do. The defaults are motors without any limit.
struct MotorParameters {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double max_force = kNone;         ///< that they show, longer ones are shortened to it [N], > 0
  double continuous_force = kNone;  ///< at which they get as warm as they may [N], > 0
  double time_constant = 60.0;      ///< of their warming up [s], > 0
  double watchdog = kNone;          ///< without a new force for so long they go off [s], > 0
};

/// The motors of a simulated device: limit, watchdog, warmth. Pure, real-time safe.
class VirtualMotors {
 public:
  explicit VirtualMotors(const MotorParameters& parameters) : parameters_(parameters) {}

  /// A new force [N], D; anything: what is not finite is none.
  void set(const Vector3& force) noexcept;
  /// What they show, as long as they are on [N], D.
  const Vector3& force() const noexcept { return force_; }
  /// For how long of the next `seconds` they are on.
  double on_for(double seconds) const noexcept;
  /// @param seconds that go by, >= 0
  void advance(double seconds) noexcept;

  double warmth() const noexcept { return warmth_; }  ///< 0 cold, 1 as warm as they may get

 private:
  MotorParameters parameters_;
  Vector3 force_ = Vector3::Zero();
  double age_ = 0.0;  ///< of the force [s]
  double warmth_ = 0.0;
};

}  // namespace irdm
