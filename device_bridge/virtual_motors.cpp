#include "device_bridge/virtual_motors.hpp"

#include <algorithm>
#include <cmath>

namespace irdm {

void VirtualMotors::set(const Vector3& force) noexcept {
  age_ = 0.0;
  force_ = force.allFinite() ? force : Vector3(Vector3::Zero());
  const double magnitude = force_.norm();
  if (magnitude > parameters_.max_force) force_ *= parameters_.max_force / magnitude;
}

double VirtualMotors::on_for(double seconds) const noexcept {
  return std::clamp(parameters_.watchdog - age_, 0.0, seconds);
}

void VirtualMotors::advance(double seconds) noexcept {
  const double on = on_for(seconds);
  const double load = force_.norm() / parameters_.continuous_force;
  const auto settle = [&](double towards, double time) {
    warmth_ += (towards - warmth_) * -std::expm1(-time / parameters_.time_constant);
  };
  settle(load * load, on);
  settle(0.0, seconds - on);
  age_ += seconds;
}

}  // namespace irdm
