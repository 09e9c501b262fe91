#pragma once

#include <Eigen/SparseCore>

#include "simulation/collision/rest_surface.hpp"

namespace irdm {

/// The force of 1 N along the outward normal of each surface node by a fingertip whose middle is
/// there, spread as by a PressureMask: column i for node i, (3n, n). Radius 0: points.
/// @param radius [m], 0..PressureMask::largest_radius(surface)
Eigen::SparseMatrix<double> fingertip_loads(const RestSurface& surface, double radius);

}  // namespace irdm
