#pragma once

namespace irdm {

struct ThermalLimits {
  double peak = 3.3;            ///< force while the motors are cold [N], > 0
  double continuous = 0.88;     ///< force that they bear for ever [N], > 0
  double time_constant = 60.0;  ///< of their warming up [s]
  double begin = 0.7;           ///< warmth from which on the peak is lowered, 0 to 1
  double slew = 20.0;           ///< of the lowered peak, either way [N/s]
};

/// Warmth of the motors, 0 cold to 1 as warm as the continuous force makes them for ever, followed
/// as a first-order lag of the square of the force; and the largest force that it leaves: the peak
/// up to `begin`, from there down to the continuous force at 1, where the warmth stays. What the
/// device itself says of its warmth counts where it is more. Pure, real-time safe.
class ThermalDerating {
 public:
  explicit ThermalDerating(const ThermalLimits& limits) : limits_(limits), limit_(limits.peak) {}

  /// @param force shown [N]
  /// @param elapsed for so long [s]
  /// @param reported warmth by the device, 0 to 1; 0 where it says nothing. Anything.
  void heat(double force, double elapsed, double reported) noexcept;

  double limit() const noexcept { return limit_; }    ///< [N]
  double warmth() const noexcept { return warmth_; }  ///< by our own account

 private:
  ThermalLimits limits_;
  double warmth_ = 0.0;
  double limit_;
};

}  // namespace irdm
