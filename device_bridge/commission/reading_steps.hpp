#pragma once

#include <cstdint>
#include <string>

#include "common/realtime/histogram.hpp"
#include "device_bridge/commission/step.hpp"

// Steps without force.
namespace irdm::commission {

inline constexpr double kPatience = 60.0;  ///< for what a person is asked to do [s]

/// Whether the handle's way has the sign and the axis that D wants.
class AxisStep final : public Step {
 public:
  static constexpr double kWay = 0.03;  ///< that is clear enough [m]

  /// @param axis of D, 0 to 2
  explicit AxisStep(int axis);

  Demand tick(const Seen& seen) noexcept override;
  bool over() const noexcept override { return clear() || time_ >= kPatience; }
  Judgement judge(Measured& measured) const override;

 private:
  bool clear() const noexcept;

  int axis_;
  bool begun_ = false;
  double time_ = 0.0;
  Vector3 start_ = Vector3::Zero();
  Vector3 way_ = Vector3::Zero();
};

/// Whether a button has the bit that it is configured with.
class ButtonStep final : public Step {
 public:
  /// @param function "grab", "clutch", "reset"  @param bit 0 to 31
  ButtonStep(const std::string& function, int bit);

  Demand tick(const Seen& seen) noexcept override;
  bool over() const noexcept override { return released_ != 0 || time_ >= kPatience; }
  Judgement judge(Measured& measured) const override;

 private:
  std::string function_;
  int bit_;
  bool begun_ = false;
  double time_ = 0.0;
  std::uint32_t before_ = 0;    ///< down in the first tick
  std::uint32_t pressed_ = 0;   ///< went down since
  std::uint32_t released_ = 0;  ///< and up again
};

/// Noise of position and velocity of a handle at rest. Position: within windows of 50 readings, so
/// that a slow drift does not count.
class RestStep final : public Step {
 public:
  static constexpr double kTime = 2.0;           ///< [s]
  static constexpr double kMostPosition = 1e-4;  ///< [m]
  static constexpr double kMostVelocity = 0.1;   ///< [m/s]
  static constexpr double kMostDrift = 5e-3;     ///< [m]
  static constexpr std::uint64_t kFewestReadings = 100;

  RestStep();

  Demand tick(const Seen& seen) noexcept override;
  bool over() const noexcept override { return time_ >= kTime; }
  Judgement judge(Measured& measured) const override;

 private:
  static constexpr int kWindow = 50;

  void add(const Vector3& tip) noexcept;
  void end_window() noexcept;

  double time_ = 0.0;
  double since_ = 0.0;  ///< the last new reading [s]
  std::uint64_t readings_ = 0;
  std::uint64_t unusable_ = 0;
  Vector3 first_ = Vector3::Zero();
  Vector3 last_ = Vector3::Zero();
  double drift_ = 0.0;  ///< farthest from the first [m]
  int in_window_ = 0;
  Vector3 sum_ = Vector3::Zero();  ///< of this window, relative to its first reading
  Vector3 squares_ = Vector3::Zero();
  Vector3 origin_ = Vector3::Zero();
  Vector3 variances_ = Vector3::Zero();  ///< of windows, added up
  int windows_ = 0;
  Vector3 speed_squares_ = Vector3::Zero();  ///< added up
};

/// Rate and jitter of the loop, and how often the device has a new reading.
class RateStep final : public Step {
 public:
  static constexpr double kTime = 3.0;           ///< [s]
  static constexpr double kLeastRate = 0.95;     ///< share of the configured rate
  static constexpr double kLeastReadings = 0.5;  ///< the same

  /// @param rate configured [Hz]
  explicit RateStep(double rate);

  Demand tick(const Seen& seen) noexcept override;
  bool over() const noexcept override { return time_ >= kTime; }
  Judgement judge(Measured& measured) const override;

 private:
  double rate_;
  double time_ = 0.0;
  std::uint64_t ticks_ = 0;
  std::uint64_t repeated_ = 0;
  Histogram off_;  ///< from the period [ns]
};

}  // namespace irdm::commission
