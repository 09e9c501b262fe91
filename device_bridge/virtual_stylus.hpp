#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "common/motion/wrench.hpp"
#include "device_bridge/haptic_device.hpp"

namespace irdm {

/// How a hand turns the stylus, as HandParameters move it. The defaults are those of a hand that
/// holds it 5 cm from the tip.
struct TurnParameters {
  double inertia = 3e-4;    ///< of hand and stylus, about any axis [kg m^2], > 0
  double damping = 5e-3;    ///< [N m s/rad], >= 0
  double stiffness = 0.75;  ///< [N m/rad], > 0
};

/// A hand that holds the stylus: a mass between a spring with a damper, whose other end moves as
/// the hand wants, and the force of the device.
struct HandParameters {
  double mass = 0.12;                       ///< of hand and stylus [kg], > 0
  double damping = 2.0;                     ///< [N s/m], >= 0
  double stiffness = 300.0;                 ///< [N/m], > 0
  std::optional<TurnParameters> turn = {};  ///< none: it turns the stylus exactly as it wants
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

/// The same for the orientation: inertia w' = stiffness r + damping (w_target - w) + torque, r the
/// rotation vector to the target. In closed form likewise, exact for turns about one axis.
class VirtualWrist {
 public:
  /// At rest at `start`, D.
  VirtualWrist(const TurnParameters& parameters, const Quaternion& start);

  /// @param dt [s], >= 0
  /// @param target how the hand wants to hold the stylus at the end of the step, D; it turns there
  /// evenly
  /// @param torque of the device on the hand, constant over the step [N m], D
  void advance(double dt, const Quaternion& target, const Vector3& torque) noexcept;

  const Quaternion& orientation() const noexcept { return orientation_; }         ///< D
  const Vector3& angular_velocity() const noexcept { return angular_velocity_; }  ///< [rad/s], D

 private:
  TurnParameters parameters_;
  Quaternion target_;
  Quaternion orientation_;
  Vector3 angular_velocity_ = Vector3::Zero();
};

/// What the motors of a device can do. The defaults are motors without any limit.
struct MotorParameters {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double max_force = kNone;         ///< that they show, longer ones are shortened to it [N], > 0
  double max_torque = kNone;        ///< the same of a torque [N m], > 0
  double continuous_force = kNone;  ///< at which they get as warm as they may [N], > 0
  double time_constant = 60.0;      ///< of their warming up [s], > 0
  double watchdog = kNone;          ///< without a new force for so long they go off [s], > 0
};

/// The motors of a simulated device: limit, watchdog, warmth. Pure, real-time safe.
class VirtualMotors {
 public:
  explicit VirtualMotors(const MotorParameters& parameters) : parameters_(parameters) {}

  /// A new force and torque, D; anything: what is not finite is none.
  void set(const Wrench& wrench) noexcept;
  /// What they show, as long as they are on, D.
  const Wrench& shown() const noexcept { return shown_; }
  /// For how long of the next `seconds` they are on.
  double on_for(double seconds) const noexcept;
  /// @param seconds that go by, >= 0
  void advance(double seconds) noexcept;

  /// They have gone off; until the next force.
  bool off() const noexcept { return age_ > parameters_.watchdog; }
  double warmth() const noexcept { return warmth_; }  ///< 0 cold, 1 as warm as they may get

 private:
  MotorParameters parameters_;
  Wrench shown_;
  double age_ = 0.0;  ///< of it [s]
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
/// script and feels what the motors show of the force, and of the torque where it has an inertia.
/// Buttons are always those of the script, and so is the orientation without such a hand.
class VirtualStylus : public HapticDevice {
 public:
  explicit VirtualStylus(StylusScript script, const std::optional<HandParameters>& hand = {},
                         const SensorParameters& sensor = {}, const MotorParameters& motors = {});

  void open() override {}
  void close() noexcept override {}
  StylusPose read(double time) noexcept override;
  void write(const Wrench& shown) noexcept override { motors_.set(shown); }
  DeviceState state() const noexcept override;
  bool simulated() const noexcept override { return true; }
  double duration() const noexcept override { return script_.end(); }
  DeviceRating rating() const noexcept override { return rating_; }
  std::string trouble() const override;

 private:
  void move_hand(double time, const StylusPose& target) noexcept;
  void advance_hand(double dt, const StylusPose& target, const Wrench& shown) noexcept;

  StylusScript script_;
  std::optional<VirtualHand> hand_;
  std::optional<VirtualWrist> wrist_;
  VirtualSensor sensor_;
  VirtualMotors motors_;
  DeviceRating rating_;
  double time_ = 0.0;
  std::atomic<bool> warm_{false};
};

/// For the registry: loads the script that the configuration names. Throws Error.
std::unique_ptr<HapticDevice> make_virtual_stylus(const DeviceConfig& config);

}  // namespace irdm
