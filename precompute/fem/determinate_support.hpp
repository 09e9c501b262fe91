#pragma once

#include "common/geometry.hpp"
#include "precompute/fem/assembly.hpp"

namespace irdm::precompute {

/// Holds a free body by six springs to the ground at three nodes far from each other. Under loads
/// that are in balance they carry no force, so that they change nothing but the rigid motion; the
/// stiffness becomes positive definite.
/// @param stiffness (3N, 3N) [N/m], with entries for each node's own block
/// @param nodes (N, 3) [m], relative to any origin inside the body
void hold_determinately(SparseMatrix& stiffness, const Points& nodes);

}  // namespace irdm::precompute
