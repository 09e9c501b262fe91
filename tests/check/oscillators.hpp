#pragma once

#include "common/stability/transfer.hpp"

namespace irdm::test {

/// One mode: h[s] of q'' + 2 sigma q' + omega^2 q = f in closed form, differences of the step
/// response; sigma < omega may be negative: it grows.
struct Mode {
  double omega;   ///< [rad/s]
  double sigma;   ///< [1/s]
  Vector3 shape;  ///< [kg^-1/2]
};

/// R_ii of a node that has these modes.
DrivingPoint driving_point(const std::vector<Mode>& modes, double dt, int steps);

/// Four modes between 10 and 200 Hz in all directions, which decay to 1e-5 in 1 s.
std::vector<Mode> damped_modes();

}  // namespace irdm::test
