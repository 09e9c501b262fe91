#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "common/geometry.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm {

/// A hand that holds the stylus: a mass between a spring with a damper, whose other end moves as
/// the hand wants, and the force of the device.
struct HandParameters {
  double mass = 0.12;        ///< of hand and stylus [kg], > 0
  double damping = 2.0;      ///< [N s/m], >= 0
  double stiffness = 300.0;  ///< [N/m], > 0
};

/// m a = stiffness (target - x) + damping (target' - v) + force, solved in closed form over each
/// step for a constant force and a target that moves evenly: exact and stable for any step.
class VirtualHand {
 public:
  /// At rest at `start` [m], D.
  VirtualHand(const HandParameters& parameters, const Vector3& start);

  /// @param dt [s], >= 0
  /// @param target where the hand wants to be at the end of the step [m], D; it moves there evenly
  /// @param force of the device on the hand, constant over the step [N], D
  void advance(double dt, const Vector3& target, const Vector3& force) noexcept;

  const Vector3& position() const noexcept { return position_; }  ///< [m], D
  const Vector3& velocity() const noexcept { return velocity_; }  ///< [m/s], D

 private:
  HandParameters parameters_;
  Vector3 target_;
  Vector3 position_;
  Vector3 velocity_ = Vector3::Zero();
};

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

/// How a device measures where its stylus is. The defaults are a perfect one.
struct SensorParameters {
  double resolution = 0.0;  ///< of each coordinate in D [m], >= 0; 0: exact. A Touch: 5.5e-5
  double noise = 0.0;       ///< standard deviation of each coordinate [m], >= 0
  std::uint32_t seed = 1;   ///< of the noise: the same seed, the same noise
};

/// Adds noise to a position and rounds it as encoders do; evenly in space, where those of a real
/// arm are in its joints. Depends on the seed and the number of readings before, on nothing else.
/// Real-time safe.
class VirtualSensor {
 public:
  explicit VirtualSensor(const SensorParameters& parameters) : parameters_(parameters) {}

  /// The next reading [m], D.
  Vector3 measure(const Vector3& tip) noexcept;

 private:
  double next_normal() noexcept;

  SensorParameters parameters_;
  std::uint64_t drawn_ = 0;
};

struct DeviceConfig;

/// A stylus without hardware: it moves as scripted, or is held by a simulated hand that follows the
/// script and feels what the motors show of the force. Orientation and buttons are always those of
/// the script.
class VirtualStylus : public HapticDevice {
 public:
  explicit VirtualStylus(StylusScript script, const std::optional<HandParameters>& hand = {},
                         const SensorParameters& sensor = {}, const MotorParameters& motors = {});

  void open() override {}
  void close() noexcept override {}
  StylusPose read(double time) noexcept override;
  void write(const Vector3& force) noexcept override { motors_.set(force); }
  DeviceState state() const noexcept override;
  bool simulated() const noexcept override { return true; }
  double duration() const noexcept override { return script_.end(); }
  ForceRating rating() const noexcept override { return rating_; }
  std::string trouble() const override;

 private:
  Vector3 move_hand(double time, const Vector3& target) noexcept;

  StylusScript script_;
  std::optional<VirtualHand> hand_;
  VirtualSensor sensor_;
  VirtualMotors motors_;
  ForceRating rating_;
  double time_ = 0.0;
  std::atomic<bool> warm_{false};
};

/// For the registry: loads the script that the configuration names. Throws Error.
std::unique_ptr<HapticDevice> make_virtual_stylus(const DeviceConfig& config);

}  // namespace irdm
