#pragma once

#include <string>

#include "scene/scene.hpp"

namespace irdm {

/// Throws Error, naming the scene, where a rigid coupling meets a fixed object.
void check_coupling(const SceneConfig& scene, const SimulationConfig& config,
                    const std::string& name);

/// What is said of a scene when its run starts.
struct SceneNotes {
  std::string note = {};      ///< a line; empty: none
  std::string warnings = {};  ///< whole lines

  void say() const;
};

/// @param name of the scene, in warnings
SceneNotes scene_notes(const SceneConfig& scene, const SimulationConfig& config, bool viewer_stylus,
                       bool lockstep, const std::string& name);

}  // namespace irdm
