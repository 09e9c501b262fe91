#pragma once

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

/// The same body of quadratic tetrahedra: a node in the middle of every edge. The nodes of the
/// linear mesh come first and keep their numbers; the new ones follow in the order in which the
/// elements meet their edges. Groups get the middles of their edges as well.
TetMesh quadratic_mesh(const TetMesh& linear);

}  // namespace irdm::precompute
