#pragma once

#include "common/model/model.hpp"

namespace irdm::precompute {

/// Speeds of plane waves in the material, without damping [m/s].
struct WaveSpeeds {
  double shear;         ///< sqrt(mu / rho)
  double rayleigh;      ///< of the free surface: root of Rayleigh's equation
  double dilatational;  ///< sqrt((lambda + 2 mu) / rho)
};
WaveSpeeds theoretical_speeds(const Material& material);

/// The tap whose wave is watched: on the surface node nearest to the centre of mass, along the axis
/// that points most directly to it.
int wave_source(const Model& model);

struct MeasuredWave {
  double arrival = 0.0;  ///< of 5 % of the first peak [m/s]; infinite when everywhere at once
  double peak = 0.0;     ///< of the first peak [m/s]
  double main = 0.0;     ///< of the largest displacement in the direction of the force [m/s]
  int nodes = 0;         ///< watched: on the source's side of the body and near its tangent plane
  int passed = 0;        ///< of these, how many saw a peak
};

/// Speeds along the surface: the nodes' distances over the times at which their total displacement
/// (elastic and rigid: the elastic part alone moves everywhere at once) first reaches 5 % of its
/// first peak, that peak, and the largest displacement along the force, by a straight line in the
/// least-squares sense. docs/wave-speed.md says what they mean. Nothing to measure (passed < 3):
/// zero.
/// @param b degree of freedom of the tap
/// @param column R[s](:, b), (steps, 3n), sampled every `dt` [s]
MeasuredWave measure_wave(const Model& model, int b, const RowMatrix<double>& column, double dt);

}  // namespace irdm::precompute
