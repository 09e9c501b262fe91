#pragma once

#include <algorithm>

#include "simulation/contact/pressure_mask.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm {

/// Returns the radius of the patch of prescribed pressure of a stylus on a surface [m]: that of its
/// fingertip, 0 for a point. A ball has such a patch only while it holds an object; the patch is
/// half as wide as the ball, as far as the surface allows.
inline double patch_radius(const SimulationStylus& stylus, const RestSurface& surface) {
  if (!stylus.has_ball()) return stylus.radius;
  return std::min(0.5 * stylus.radius, PressureMask::largest_radius(surface));
}

}  // namespace irdm
