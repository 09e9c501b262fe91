#pragma once

#include <Eigen/Dense>
#include <array>

#include "common/geometry.hpp"
#include "precompute/fem/material.hpp"
#include "precompute/mesh/tet_mesh.hpp"

/// The linear tetrahedron: displacement linear, strain and stress constant within it.
namespace irdm::precompute::tet4 {

using Corners = Eigen::Matrix<double, 4, 3>;        ///< rest positions [m], one a row
using Displacements = Eigen::Matrix<double, 4, 3>;  ///< of the corners [m], one a row
using Stiffness = Eigen::Matrix<double, 12, 12>;    ///< [N/m], index 3 corner + axis

struct Geometry {
  double volume;                         ///< [m^3], signed
  Eigen::Matrix<double, 4, 3> gradient;  ///< of the four shape functions [1/m], one a row
};

/// The corners must not lie in a plane.
Geometry geometry(const Corners& corners);

/// Stress [Pa] at the given displacements.
Matrix3 stress(const Geometry& geometry, const Lame& lame, const Displacements& displacements);

/// Element stiffness: symmetric, positive semidefinite, without the six rigid motions.
Stiffness stiffness(const Geometry& geometry, const Lame& lame);

}  // namespace irdm::precompute::tet4

/// The quadratic tetrahedron: with straight edges displacement quadratic, strain and stress linear
/// within it. Nodes are the four corners and the six mid-side nodes in the order of kTetEdges. Its
/// shape is that of the linear tetrahedron on its corners, hence tet4::Geometry; where edges are
/// curved, that of another linear one at each point (isoparametric). Unlike the linear one it does
/// not lock as the Poisson ratio nears 0.5.
namespace irdm::precompute::tet10 {

using Barycentric = Eigen::Vector4d;                 ///< a point of the element, sums to one
using Gradients = Eigen::Matrix<double, 10, 3>;      ///< of the shape functions [1/m]
using Displacements = Eigen::Matrix<double, 10, 3>;  ///< of the nodes [m], one a row
using Stiffness = Eigen::Matrix<double, 30, 30>;     ///< [N/m], index 3 node + axis

/// The linear tetrahedron with the map that element e of a quadratic mesh has near a point. With
/// straight edges it is the same everywhere.
tet4::Geometry geometry(const TetMesh& mesh, int e, const Barycentric& b);

/// Gradients of the shape functions b_i (2 b_i - 1) of the corners and 4 b_i b_j of the mid-side
/// nodes at a point.
Gradients gradients(const tet4::Geometry& geometry, const Barycentric& b);

/// The four points, of equal weights, of a rule that integrates quadratics exactly.
std::array<Barycentric, 4> quadrature_points();

/// Stress [Pa] at a point, at the given displacements.
Matrix3 stress(const tet4::Geometry& geometry, const Barycentric& b, const Lame& lame,
               const Displacements& displacements);

/// Stiffness of element e: symmetric, positive semidefinite, without the six rigid motions. The
/// four quadrature points integrate quadratics exactly, and with straight edges nothing of higher
/// degree occurs.
Stiffness stiffness(const TetMesh& mesh, int e, const Lame& lame);

/// Share of the element's mass that each node gets (see lumped_mass).
Eigen::Matrix<double, 10, 1> mass_shares();

}  // namespace irdm::precompute::tet10

namespace irdm::precompute {

/// Its corners [m], one a row.
tet4::Corners corners_of(const TetMesh& mesh, int e);

/// Volume of element e [m^3], positive; with curved edges by the four points of quadrature.
double element_volume(const TetMesh& mesh, int e);

}  // namespace irdm::precompute
