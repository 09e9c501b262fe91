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

/// Time over distance as a straight line.
struct FittedPassage {
  double slowness = 0.0;  ///< its slope [s/m]
  double error = 0.0;     ///< standard error of the slope [s/m]
  double speed() const;   ///< [m/s]; infinite when everywhere at once
};

struct MeasuredWave {
  FittedPassage arrival;  ///< of 5 % of the first peak
  FittedPassage peak;     ///< of the first peak
  FittedPassage main;     ///< of the largest displacement in the direction of the force
  int nodes = 0;          ///< watched: on the source's side of the body and near its tangent plane
  int passed = 0;         ///< of these, how many saw a peak
  int distances = 0;      ///< of these, how many different ones from the source
};

/// Speeds along the surface: the nodes' distances over the times at which their total displacement
/// (nodes that are equally far count as one; elastic and rigid: the elastic part alone moves
/// everywhere at once) first reaches 5 % of its first peak, that peak, and the largest displacement
/// along the force, by a straight line in the least-squares sense. docs/check.md says what
/// they mean. Nothing to measure (distances < 3): zero.
/// @param b degree of freedom of the tap
/// @param column R[s](:, b), (steps, 3n), sampled every `dt` [s]
MeasuredWave measure_wave(const Model& model, int b, const RowMatrix<double>& column, double dt);

}  // namespace irdm::precompute
