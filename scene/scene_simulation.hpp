#pragma once

#include "scene/columns/scene_columns.hpp"
#include "scene/scene.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm {

/// Whether viewers get a stylus of their own, which comes after those of the scene.
bool has_viewer_stylus(const SceneConfig& scene, bool lockstep);

/// Whether a trace of so many styluses has that of the viewers. Throws Error, naming the trace,
/// when it is not of this scene.
bool recorded_viewer_stylus(const SceneConfig& scene, int stylus_count, const std::string& trace);

/// What a scene asks to simulate, with its models read. Throws Error.
/// @param columns of models with a memory_budget, to be started then; null: they are read whole
SimulationConfig simulation_config(const SceneConfig& scene, bool viewer_stylus,
                                   SceneColumns* columns = nullptr);

}  // namespace irdm
