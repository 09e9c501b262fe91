#include "tests/check/oscillators.hpp"

#include <cmath>

namespace irdm::test {

using namespace precompute;
namespace {

// Answer at time t >= 0 to f = 1 from t = 0 on.
double step_response(const Mode& mode, double t) {
  const double damped = std::sqrt(mode.omega * mode.omega - mode.sigma * mode.sigma);
  return (1.0 - std::exp(-mode.sigma * t) *
                    (std::cos(damped * t) + mode.sigma / damped * std::sin(damped * t))) /
         (mode.omega * mode.omega);
}

}  // namespace

DrivingPoint driving_point(const std::vector<Mode>& modes, double dt, int steps) {
  DrivingPoint record = DrivingPoint::Zero(9, steps);
  for (const Mode& mode : modes) {
    const Matrix3 product = mode.shape * mode.shape.transpose();
    for (int s = 0; s < steps; ++s) {
      record.col(s) +=
          (step_response(mode, (s + 1) * dt) - step_response(mode, s * dt)) * product.reshaped();
    }
  }
  return record;
}

std::vector<Mode> damped_modes() {
  return {{63.0, 12.0, Vector3(1.0, 0.2, -0.3)},
          {190.0, 14.0, Vector3(-0.4, 1.1, 0.1)},
          {400.0, 20.0, Vector3(0.2, -0.3, 0.9)},
          {1250.0, 60.0, Vector3(0.8, 0.7, -0.6)}};
}

}  // namespace irdm::test
