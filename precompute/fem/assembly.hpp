#pragma once

#include <Eigen/Sparse>

#include "precompute/fem/material.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

using SparseMatrix = Eigen::SparseMatrix<double>;
using RowSparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Stiffness of the whole mesh [N/m], (3N, 3N), index 3 node + axis; both triangles are stored.
SparseMatrix assemble_stiffness(const TetMesh& mesh, const Lame& lame);

/// The rows of nodes first..last-1 of it alone, (3 (last - first), 3N): for one of several
/// processes that share the matrix. Nothing is computed of elements without such a node.
RowSparseMatrix assemble_stiffness_rows(const TetMesh& mesh, const Lame& lame, int first, int last);

/// Lumped mass [kg], (N), all > 0. Every linear tetrahedron gives a quarter of its mass to each
/// corner, every quadratic one 1/36 to each corner and 4/27 to each mid-side node: the diagonal of
/// the consistent mass matrix, scaled to the mass of the element (Hinton, Rock and Zienkiewicz, A
/// note on mass lumping, Earthquake Eng. Struct. Dyn. 4, 1976). Row sums would give the corners
/// -1/20. Total mass and centre of mass are those of the solid.
/// @param density [kg/m^3]
Eigen::VectorXd lumped_mass(const TetMesh& mesh, double density);

}  // namespace irdm::precompute
