#include "device_bridge/virtual_stylus.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/motion/rigid_body.hpp"
#include "device_bridge/bridge_config.hpp"

namespace irdm {
namespace {

/// exp(-a t) cos(w t) and exp(-a t) sin(w t) / w for w^2 = `discriminant` of either sign.
struct Decay {
  double cosine;
  double sine;
};

Decay decay(double a, double discriminant, double t) noexcept {
  const double w = std::sqrt(std::abs(discriminant));
  if (w * t < 1e-6) return {std::exp(-a * t), t * std::exp(-a * t)};
  if (discriminant > 0.0) {
    return {std::exp(-a * t) * std::cos(w * t), std::exp(-a * t) * std::sin(w * t) / w};
  }
  // Two exponentials that both decay: cosh alone would overflow for a strong damper.
  const double slow = std::exp((w - a) * t);
  const double fast = std::exp((-w - a) * t);
  return {0.5 * (slow + fast), 0.5 * (slow - fast) / w};
}

/// A damped oscillator relative to where it rests: place and velocity, after `dt` of swinging.
struct Swing {
  Vector3 place;
  Vector3 velocity;

  Swing after(double dt, double inertia, double damping, double stiffness) const noexcept {
    const double a = 0.5 * damping / inertia;
    const double square = stiffness / inertia;  // of the undamped angular frequency
    const Decay d = decay(a, square - a * a, dt);
    return {(d.cosine + a * d.sine) * place + d.sine * velocity,
            (d.cosine - a * d.sine) * velocity - square * d.sine * place};
  }
};

Vector3 shortened(const Vector3& vector, double most) noexcept {
  if (!vector.allFinite()) return Vector3::Zero();
  const double magnitude = vector.norm();
  return magnitude > most ? Vector3(most / magnitude * vector) : vector;
}

}  // namespace

VirtualHand::VirtualHand(const HandParameters& parameters, const Vector3& start)
    : parameters_(parameters), target_(start), position_(start) {}

void VirtualHand::advance(double dt, const Vector3& target, const Vector3& force) noexcept {
  if (!(dt > 0.0)) return;
  const auto& [mass, damping, stiffness, turn] = parameters_;
  // Relative to the moving target, and to where the force would hold it for good.
  const Vector3 target_velocity = (target - target_) / dt;
  const Vector3 sag = force / stiffness;
  const Swing begin{position_ - target_ - sag, velocity_ - target_velocity};
  const Swing end = begin.after(dt, mass, damping, stiffness);
  position_ = target + sag + end.place;
  velocity_ = target_velocity + end.velocity;
  target_ = target;
}

VirtualWrist::VirtualWrist(const TurnParameters& parameters, const Quaternion& start)
    : parameters_(parameters), target_(start), orientation_(start) {}

void VirtualWrist::advance(double dt, const Quaternion& target, const Vector3& torque) noexcept {
  if (!(dt > 0.0)) return;
  const auto& [inertia, damping, stiffness] = parameters_;
  const Vector3 target_velocity = rotation_vector(target * target_.conjugate()) / dt;
  const Vector3 sag = torque / stiffness;
  const Swing begin{rotation_vector(orientation_ * target_.conjugate()) - sag,
                    angular_velocity_ - target_velocity};
  const Swing end = begin.after(dt, inertia, damping, stiffness);
  orientation_ = (rotation_from_vector(sag + end.place) * target).normalized();
  angular_velocity_ = target_velocity + end.velocity;
  target_ = target;
}

void VirtualMotors::set(const Wrench& wrench) noexcept {
  age_ = 0.0;
  shown_ = {shortened(wrench.force, parameters_.max_force),
            shortened(wrench.torque, parameters_.max_torque)};
}

double VirtualMotors::on_for(double seconds) const noexcept {
  return std::clamp(parameters_.watchdog - age_, 0.0, seconds);
}

void VirtualMotors::advance(double seconds) noexcept {
  const double on = on_for(seconds);
  const double load = shown_.force.norm() / parameters_.continuous_force;
  const auto settle = [&](double towards, double time) {
    warmth_ += (towards - warmth_) * -std::expm1(-time / parameters_.time_constant);
  };
  settle(load * load, on);
  settle(0.0, seconds - on);
  age_ += seconds;
}

namespace {

// A well-mixed function of its argument (splitmix64): numbers in a row give numbers at random.
std::uint64_t mix(std::uint64_t x) noexcept {
  x += 0x9E3779B97F4A7C15;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
  return x ^ (x >> 31);
}

// Evenly in (0, 1].
double uniform(std::uint64_t x) noexcept {
  constexpr double kUnit = 0x1p-53;
  return kUnit * static_cast<double>((mix(x) >> 11) + 1);
}

}  // namespace

// Box and Muller's pair, of which one is enough.
double VirtualSensor::next_normal() noexcept {
  const std::uint64_t stream = std::uint64_t{parameters_.seed} << 32;
  const double radius = std::sqrt(-2.0 * std::log(uniform(mix(stream) + drawn_)));
  const double angle = 2.0 * std::numbers::pi * uniform(mix(stream) + drawn_ + 1);
  drawn_ += 2;
  return radius * std::cos(angle);
}

Vector3 VirtualSensor::measure(const Vector3& tip) noexcept {
  const auto& [resolution, noise, seed] = parameters_;
  Vector3 measured = tip;
  if (noise > 0.0) {
    for (double& coordinate : measured) coordinate += noise * next_normal();
  }
  if (resolution > 0.0) {
    for (double& coordinate : measured) {
      coordinate = resolution * std::round(coordinate / resolution);
    }
  }
  return measured;
}

VirtualStylus::VirtualStylus(StylusScript script, const std::optional<HandParameters>& hand,
                             const SensorParameters& sensor, const MotorParameters& motors)
    : script_(std::move(script)),
      sensor_(sensor),
      motors_(motors),
      rating_{.peak = motors.max_force,
              .continuous = motors.continuous_force,
              .resolution = std::max(sensor.resolution, kNoiseSteps * sensor.noise)} {
  if (!hand) return;
  const StylusPose start = script_.at(0.0);
  hand_.emplace(*hand, start.tip);
  if (!hand->turn) return;
  wrist_.emplace(*hand->turn, start.orientation);
  rating_.peak_torque = motors.max_torque;
}

StylusPose VirtualStylus::read(double time) noexcept {
  StylusPose pose = script_.at(time);
  if (hand_) {
    move_hand(time, pose);
    pose.tip = hand_->position();
  }
  if (wrist_) pose.orientation = wrist_->orientation();
  motors_.advance(std::max(0.0, time - time_));
  warm_.store(motors_.warmth() >= 1.0, std::memory_order_relaxed);
  time_ = time;
  pose.tip = sensor_.measure(pose.tip);
  return pose;
}

// The motors may go off on the way.
void VirtualStylus::move_hand(double time, const StylusPose& target) noexcept {
  const double elapsed = time - time_;
  const double on = elapsed > 0.0 ? motors_.on_for(elapsed) : elapsed;
  if (on < elapsed) {
    advance_hand(on, script_.at(time_ + on), motors_.shown());
    advance_hand(elapsed - on, target, {});
  } else {
    advance_hand(elapsed, target, motors_.shown());
  }
}

void VirtualStylus::advance_hand(double dt, const StylusPose& target,
                                 const Wrench& shown) noexcept {
  hand_->advance(dt, target.tip, shown.force);
  if (wrist_) wrist_->advance(dt, target.orientation, shown.torque);
}

DeviceState VirtualStylus::state() const noexcept {
  return {.motor_temperature = std::min(motors_.warmth(), 1.0), .off = motors_.off()};
}

std::string VirtualStylus::trouble() const {
  if (!warm_.load(std::memory_order_relaxed)) return {};
  return "virtual stylus: its motors are warm; less force until they have cooled down";
}

std::unique_ptr<HapticDevice> make_virtual_stylus(const DeviceConfig& config) {
  return std::make_unique<VirtualStylus>(StylusScript::load(config.script), config.hand,
                                         config.sensor, config.motors);
}

}  // namespace irdm
