#pragma once

#include "common/geometry.hpp"

namespace irdm::precompute {

/// The rotation Q nearest to F, which maximises tr(Q^T F): the orthogonal factor of the polar
/// decomposition F = Q S where det F > 0, by Newton's iteration Q <- (Q + Q^-T) / 2 with scaling
/// (Higham, Computing the polar decomposition, SIAM J. Sci. Stat. Comput. 7, 1986). Where F is
/// singular or turned inside out, from its singular values; det Q = 1 always.
Matrix3 polar_rotation(const Matrix3& F);

}  // namespace irdm::precompute
