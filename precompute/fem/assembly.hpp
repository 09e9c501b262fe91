#pragma once

#include <Eigen/Sparse>

#include "precompute/fem/material.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Stiffness of the whole mesh [N/m], (3N, 3N), index 3 node + axis; both triangles are stored.
SparseMatrix assemble_stiffness(const TetMesh& mesh, const Lame& lame);

/// Lumped mass [kg], (N): every tetrahedron gives a quarter of its mass to each corner.
/// @param density [kg/m^3]
Eigen::VectorXd lumped_mass(const TetMesh& mesh, double density);

}  // namespace irdm::precompute
