#pragma once

#include "common/model/model.hpp"

namespace irdm::precompute {

/// h_i[s] of all modes: shape (T, r), row s. R[s] = Phi diag(h[s]) Phi^T (design of equation (10):
/// force held during one step). [m/N kg]
RowMatrix<double> held_responses(const ModalResponse& response, double dt, int steps);

/// How much of R is left where it is cut off: over all surface degrees of freedom a, the largest
/// ratio of a bound of |R[s](a, a)| for all s >= T-1 to the peak of |R[s](a, a)| over s < T. The
/// bound sums sqrt(q^2 + v^2 / omega^2) at step T-1 over the modes: the energy of a mode never
/// grows, so that its displacement never exceeds that later, whatever its phase is at T-1.
/// @param response with shapes in double precision
double decay_left(const ModalResponse& response, double dt, int steps);

}  // namespace irdm::precompute
