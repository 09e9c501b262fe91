#pragma once

#include <Eigen/Dense>

#include "common/geometry.hpp"
#include "precompute/fem/material.hpp"

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
