#pragma once

#include <Eigen/Dense>
#include <vector>

#include "common/model/model.hpp"
#include "precompute/modal/elastic_statics.hpp"

namespace irdm::precompute {

/// Share c of a mode's response that it keeps as a mode: all of it up to half the frequency where
/// the modes end, none there, a cosine in omega^2 between. The rest, (1 - c) / omega^2, belongs to
/// the residual compliance. Where modes ended at once, what they lack would ring through the body
/// like any sharp filter, be cut off in the middle of that, and could give energy; so it falls off
/// within about a wavelength.
/// @param cut_off angular frequency of the first mode that is left out [rad/s]
double kept_share(double omega, double cut_off);

/// The lowest `count` of more modes than that, shapes and forces of loads on the whole body times
/// sqrt(c).
/// @param modes with shapes in double precision, more than `count`
ModalResponse smoothly_cut(const ModalResponse& modes, int count);

/// What a load feels of the whole body: with b the load and a_i = b . phi_i over *all* elastic
/// modes, sum_i a_i^2 h_i[s] is its own response. Here in few oscillators instead of all modes.
struct DrivingSpectrum {
  Eigen::VectorXd angular_frequency;  ///< [rad/s], > 0
  Eigen::VectorXd weight;             ///< in place of a_i^2 [1/kg], >= 0
};

/// The spectra of several loads by Gauss quadrature: Lanczos on M^1/2 K^+ M^1/2 from the load
/// (Golub and Meurant, Matrices, Moments and Quadrature, 2010). With m steps the 2m lowest moments
/// of 1 / omega^2 are those of all modes, so that the static compliance is exact and what is slow
/// against the quadrature's own frequencies as good as exact; no mode is computed for it.
/// @param loads on all nodes, (3N, k) [N]
/// @param steps m > 0
std::vector<DrivingSpectrum> driving_spectra(const ElasticStatics& statics,
                                             const Eigen::MatrixXd& loads, int steps);

/// sum_j weight_j h_j[s], (T) [m/N].
Eigen::VectorXd driving_response(const DrivingSpectrum& spectrum, const Material& material,
                                 double dt, int steps);

}  // namespace irdm::precompute
