#pragma once

#include "simulation/step/simulation_config.hpp"

namespace irdm {

/// Radius of the fingertip of a stylus that names none, for the objects of a scene [m]: 1.65 V / S
/// of the smallest one, V its volume and S its surface (0.55 of a ball's radius, 0.83 of a rod's or
/// of half a sheet's thickness), but at least the longest mean edge and at most what a PressureMask
/// takes. So wide it feels the shape and not the mesh: on balls of 400 and 1600 surface nodes its
/// compliance differs by less than 3 %, over each by less than 5 %. 0: all of them are rigid.
double default_fingertip(const SimulationConfig& config);

/// Returns the radius of a stylus' ball that names none [m]: twice the mean edge length of the
/// coarsest surface and at least 3 mm, but at most a tenth of the diameter of the smallest object,
/// taken as 6 V / S. Rigid objects count as well.
double default_ball_radius(const SimulationConfig& config);

/// By which factor points on neighbouring nodes of an object differ in static compliance where a
/// fingertip feels the same; the median over all edges of triangles. NaN: not known, or rigid.
/// @param radius of the fingertip [m], > 0
double mesh_dependence_of_points(const Model& model, double radius);

}  // namespace irdm
