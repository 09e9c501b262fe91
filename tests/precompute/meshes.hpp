#pragma once

#include <array>

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::test {

using namespace precompute;

/// A box filled by TetGen: irregular inside.
TetMesh box_mesh(const Vector3& size, const std::array<int, 3>& cells);

/// One tetrahedron with corners at the origin and at 1 m along each axis.
TetMesh one_tet();

/// Two tetrahedra that share a face.
TetMesh two_tets();

/// Both meshes side by side in one, joined nowhere.
TetMesh together(const TetMesh& a, const TetMesh& b);

}  // namespace irdm::test
