#include "device_bridge/virtual_hand.hpp"

#include <cmath>

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

}  // namespace

VirtualHand::VirtualHand(const HandParameters& parameters, const Vector3& start)
    : parameters_(parameters), target_(start), position_(start) {}

void VirtualHand::advance(double dt, const Vector3& target, const Vector3& force) noexcept {
  if (!(dt > 0.0)) return;
  const auto& [mass, damping, stiffness] = parameters_;
  const double a = 0.5 * damping / mass;
  const double square = stiffness / mass;  // of the undamped angular frequency
  const Decay d = decay(a, square - a * a, dt);
  // Relative to the moving target, and to where the force would hold it for good.
  const Vector3 target_velocity = (target - target_) / dt;
  const Vector3 sag = force / stiffness;
  const Vector3 y = position_ - target_ - sag;
  const Vector3 u = velocity_ - target_velocity;
  position_ = target + sag + (d.cosine + a * d.sine) * y + d.sine * u;
  velocity_ = target_velocity + (d.cosine - a * d.sine) * u - square * d.sine * y;
  target_ = target;
}

}  // namespace irdm
