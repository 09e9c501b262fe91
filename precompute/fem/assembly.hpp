#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "common/geometry.hpp"
#include "common/response/modal_response.hpp"
#include "precompute/fem/material.hpp"
#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

using SparseMatrix = Eigen::SparseMatrix<double>;
using RowSparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Stiffness of the whole mesh [N/m], (3N, 3N), index 3 node + axis; both triangles are stored.
/// Each element has its own material, where there are several.
SparseMatrix assemble_stiffness(const TetMesh& mesh, const Material& material);

/// The rows of nodes first..last-1 of it alone, (3 (last - first), 3N): for one of several
/// processes that share the matrix. Nothing is computed of elements without such a node.
RowSparseMatrix assemble_stiffness_rows(const TetMesh& mesh, const Material& material, int first,
                                        int last);

/// Lumped mass [kg], (N), all > 0. Every linear tetrahedron gives a quarter of its mass to each
/// corner, every quadratic one 1/36 to each corner and 4/27 to each mid-side node: the diagonal of
/// the consistent mass matrix, scaled to the mass of the element (Hinton, Rock and Zienkiewicz, A
/// note on mass lumping, Earthquake Eng. Struct. Dyn. 4, 1976). Row sums would give the corners
/// -1/20. Total mass and, with straight edges, centre of mass are those of the solid.
/// @param material of which the densities count
Eigen::VectorXd lumped_mass(const TetMesh& mesh, const Material& material);

/// Nodal loads of a body that turns: shape (3N, 6), one column a product of SpinProducts. With
/// q = spin_products(w) the columns add up to m_i (|w|^2 X_i - w (w . X_i)) on node i, the
/// centrifugal force [N] where w is in rad/s. [kg m]
/// @param nodes X (N, 3) [m], B: the centre of mass is the origin
/// @param mass lumped (N) [kg]
Eigen::Matrix<double, Eigen::Dynamic, kSpinProducts> centrifugal_loads(const Points& nodes,
                                                                       const Eigen::VectorXd& mass);

/// Nodal loads of a body all of which is accelerated alike, as gravity does: shape (3N, 3), one
/// column an axis, m_i on node i along it. [kg]
/// @param mass lumped (N) [kg]
Eigen::Matrix<double, Eigen::Dynamic, 3> uniform_loads(const Eigen::VectorXd& mass);

}  // namespace irdm::precompute
