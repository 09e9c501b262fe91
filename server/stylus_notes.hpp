#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace irdm {

/// "stylus 1", "styluses 1, 3 and the viewers' stylus".
/// @param numbers from 0, increasing, not empty
/// @param viewer_stylus number of that one; as many as there are: none
std::string list_of_styluses(const std::vector<std::size_t>& numbers, std::size_t viewer_stylus);

/// Returns what is said at the start about styluses that name no radius; empty if all of them do.
std::string default_radius_note(const SceneConfig& scene, const SimulationConfig& config,
                                bool viewer_stylus);

/// Of styluses that are points on objects that deform: that they feel the mesh, and by how much.
/// Empty: there is none.
std::string point_warning(const SceneConfig& scene, const SimulationConfig& config,
                          bool viewer_stylus);

/// Of a coupling stiffer than what `irdm-precompute check` finds stable over a link, on some nodes
/// (sampled_coupling()) of the object that bears least. Empty: none is.
std::string coupling_warning(const SceneConfig& scene, const SimulationConfig& config);

}  // namespace irdm
