#pragma once

#include "precompute/mesh/surface_mesh.hpp"

namespace irdm::precompute {

// Surfaces of round bodies about the origin, of radius 1, normals outward. All nodes lie on the
// round surface: what is inside is smaller by a share that falls with the square of the cell size.

/// The grid of a cube's faces, bent onto the sphere in nearly equal cells.
/// @param cells along each edge of the cube, four of which go round the sphere, >= 1
SurfaceMesh sphere_surface(int cells);

/// A cylinder along the y axis with half a sphere at each end.
/// @param length between the centres of the half spheres, in radii, > 0
/// @param cells as of the sphere; the cylinder has capsule_rows() of them along
SurfaceMesh capsule_surface(double length, int cells);

/// Cells along the cylinder of a capsule: an even number, so that an even number of cells makes a
/// symmetric body, each about as long as those round it.
double capsule_rows(double length, int cells);

}  // namespace irdm::precompute
