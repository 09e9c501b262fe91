#pragma once

#include "common/model/model.hpp"

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

}  // namespace irdm::precompute
