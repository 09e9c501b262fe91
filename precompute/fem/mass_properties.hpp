#pragma once

#include "precompute/mesh/tet_mesh.hpp"

namespace irdm::precompute {

struct MassProperties {
  double mass;             ///< [kg]
  Vector3 centre_of_mass;  ///< [m], coordinates of the mesh
  Matrix3 inertia;         ///< about the centre of mass [kg m^2], axes of the mesh
};

/// Of the body that the tetrahedra fill: the integrals are exact.
/// @param material of which the densities count
MassProperties solid_mass_properties(const TetMesh& mesh, const Material& material);

/// Of point masses at the nodes. With lumped_mass(), mass and centre of mass are those of the
/// solid; the inertia is larger, because lumping moves mass away from the middle of every element,
/// by a share that falls with the square of the element size (cube of 12 cells an edge: 2.4 %, of
/// 6: 7.5 %, of 6 with quadratic tetrahedra: 1.9 %). It is the inertia that the discrete equations
/// of motion have: the elastic modes are orthogonal to rigid motions of these masses, so that rigid
/// motion with this inertia plus elastic response is the motion of the mesh, and the elastic part
/// carries no momentum (equations (1)(2)). The model file of a soft body has this one.
/// @param mass (N) [kg]
MassProperties nodal_mass_properties(const Points& nodes, const Eigen::VectorXd& mass);

}  // namespace irdm::precompute
