#pragma once

#include <optional>

#include "scene/scene.hpp"
#include "scene/scene_source.hpp"
#include "server/scene_notes.hpp"
#include "simulation/step/simulation.hpp"
#include "trace/trace_layout.hpp"
#include "viewer/message.hpp"

namespace irdm {

/// A scene at its start, with all that takes long already done. It knows no thread and no socket.
struct PreparedRun {
  /// Reads models and places objects. Throws Error. Large models take seconds.
  /// @param scene read from `source`
  /// @param records whether anything of the run may be recorded
  PreparedRun(SceneSource source, SceneConfig scene, bool lockstep, bool records);

  SceneSource source;
  SceneConfig scene;
  bool lockstep;
  bool viewer_stylus;
  SceneColumns columns;
  SimulationConfig config;
  Simulation simulation;
  SceneNotes notes;
  TraceHeader header;                 ///< empty when nothing may be recorded
  std::optional<viewer::Scene> seen;  ///< by viewers; none: there are none

  std::string name = {};      ///< in the list of scenes; empty: it is not there
  std::string greeting = {};  ///< first notice to viewers
};

/// Names of the objects.
std::vector<std::string> names_of(const SceneConfig& scene);

}  // namespace irdm
