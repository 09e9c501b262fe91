#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "common/motion/wrench.hpp"
#include "common/stylus.hpp"
#include "device_bridge/safety/arming.hpp"
#include "device_bridge/safety/guards.hpp"
#include "device_bridge/safety/oscillation_detector.hpp"
#include "device_bridge/safety/passivity.hpp"
#include "device_bridge/safety/sensor_plausibility.hpp"

namespace irdm {

/// The bounds of what a device may do to a hand. The defaults are those of a Touch.
struct FilterLimits {
  double max_force = 3.3;                    ///< [N], > 0
  double continuous_force = 0.88;            ///< that the motors bear for ever [N], > 0
  double max_torque = 0.0;                   ///< [N m]; 0: the device renders none
  double continuous_torque = 0.05;           ///< that the motors bear for ever [N m], > 0
  std::int64_t max_horizon_ns = 50'000'000;  ///< no demand is trusted for longer than this
  /// In which one that is too old goes to zero; with the tick that shows it at most 30 ms.
  std::int64_t fade_ns = 29'000'000;
  double fade_damping = 2.0;    ///< while it does [N s/m]; of a turn times kLever^2 [N m s/rad]
  double needed_success = 0.0;  ///< LinkGate's, below which it does not arm; 0: arms at once
  ReadingLimits reading = {};
  ArmingLimits arming = {};
  PassivityLimits passivity = {};
  OscillationLimits oscillation = {};
  RateLimits rate = {};
  RateLimits torque_rate = {.rise = 15.0, .fall = 60.0};
};

/// The device at one tick.
struct DeviceReading {
  Vector3 tip = Vector3::Zero();                    ///< [m], D; anything
  Quaternion orientation = Quaternion::Identity();  ///< in D; anything
  double motor_temperature = 0.0;  ///< what the device says, 0 to 1; 0: it says nothing
  bool repeated = false;           ///< of a moment ago, nothing newer
  bool saturated = false;          ///< since the last tick less was shown than was sent
  bool off = false;                ///< nothing is shown any more: what was sent is forgotten
};

/// The force and torque that the world asks for at one tick, and what they rest on. Nothing in it
/// is trusted.
struct ForceDemand {
  static constexpr std::int64_t kHoldHorizonNs = 20'000'000;
  static constexpr double kMostEnergy = std::numeric_limits<double>::max();  ///< no bound [J]

  bool linked = false;                       ///< a session is on
  bool any = false;                          ///< the rest means something
  std::int64_t sample_time_ns = 0;           ///< of the newest stylus sample that it contains
  std::int64_t horizon_ns = kHoldHorizonNs;  ///< how long after that it is good
  bool solved_here = false;                  ///< from a tip of its own, not from that sample's
  std::int64_t solved_ns = 0;                ///< when that tip was read; if solved_here
  double energy = kMostEnergy;               ///< that the device may give [J], D; if solved_here
  ContactState contact = ContactState::kFree;
  Vector3 force = Vector3::Zero();   ///< on the stylus [N], D
  Vector3 torque = Vector3::Zero();  ///< on the stylus about its tip [N m], D
  Vector3 normal = Vector3::Zero();  ///< outward, of the surface; unit, D; zero: not known
};

/// What the filter has done so far.
struct FilterCounts {
  std::uint64_t readings = 0;  ///< not used
  std::uint64_t demands = 0;   ///< not used: not finite, old, of the future
  std::uint64_t trips = 0;     ///< the force was dropped, to come back slowly
  std::uint64_t faults = 0;    ///< the force was dropped for good
};

/// The last word before the device. Each tick, in this order: sanity of the reading; newest demand;
/// its age; no pull unless held; gain; passivity; rate limit; largest force; warmth of the motors.
/// Force and torque share age, gain, damping and the account of energy; each has limits of its own,
/// so that a spring stays one where it is cut off. The observer of passivity is told what was
/// really sent; where the motors showed less, what that took does not count. Whatever comes in, no
/// force or torque that goes out is beyond the limits of magnitude and rate. Pure: knows no clock,
/// thread or file; what it does depends on its arguments alone. Real-time safe. One thread. Large:
/// each guard is a member of a class of its own; their order is the purpose of it.
class SafetyFilter {
 public:
  /// @param guards all but in tests
  explicit SafetyFilter(const FilterLimits& limits, Guards guards = {});

  /// An action of the person, or of who acts for them: at once, or when the link has become good
  /// enough.
  void arm() noexcept;
  void disarm() noexcept;
  /// The device says that something is wrong with it.
  void fail() noexcept;

  /// What to show from now until the next tick, D.
  /// @param now_ns clock of ForceDemand::sample_time_ns; back is a fault
  Wrench step(std::int64_t now_ns, const DeviceReading& reading,
              const ForceDemand& demand) noexcept;

  FilterState state() const noexcept { return arming_.state(); }
  /// Told to arm, and the link is not good enough yet.
  bool waits() const noexcept { return waits_; }
  const FilterCounts& counts() const noexcept { return counts_; }
  double success_rate() const noexcept { return gate_.success_rate(); }
  double port_energy() const noexcept { return passivity_.energy(); }  ///< see Passivity [J]
  /// Of a force that was solved here, see Passivity::share().
  double energy_share() const noexcept { return held_.solved_here ? passivity_.share() : 1.0; }
  double gain() const noexcept { return oscillation_.gain(); }  ///< see OscillationDetector
  double warmth() const noexcept { return std::max(thermal_.warmth(), torque_thermal_.warmth()); }

 private:
  ReadingVerdict check(std::int64_t now_ns, const DeviceReading& reading) noexcept;
  void accept(std::int64_t now_ns, const ForceDemand& demand) noexcept;
  void grant(const ForceDemand& demand) noexcept;
  double age(std::int64_t now_ns) const noexcept;
  std::int64_t beyond_horizon(std::int64_t now_ns, const ForceDemand& demand) const noexcept;
  double fresh(std::int64_t now_ns) const noexcept;
  void watch_link(double fresh) noexcept;
  void observe(std::int64_t now_ns, bool in_part) noexcept;
  void forget_sent() noexcept;
  Wrench wanted() const noexcept;
  Wrench damped(const Wrench& wrench, double share) const noexcept;
  Wrench limited(const Wrench& wrench) const noexcept;
  Wrench shortened(const Wrench& wrench) const noexcept;

  FilterLimits limits_;
  Guards guards_;
  SensorPlausibility reading_;
  Arming arming_;
  LinkGate gate_;
  bool waits_ = false;  ///< told to arm, and the link is not good enough yet
  Passivity passivity_;
  OscillationDetector oscillation_;
  WorldWork world_;
  ThermalDerating thermal_;
  ThermalDerating torque_thermal_;
  ForceDemand held_;     ///< the newest that was accepted
  ForceDemand in_time_;  ///< the newest of these that was within its horizon when it came
  std::optional<std::int64_t> lost_since_ns_;
  double age_ = 0.0;  ///< of the tip that it answers, at the last tick [s]
  Wrench sent_;
  FilterCounts counts_;
};

}  // namespace irdm
