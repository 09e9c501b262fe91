#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm::replay {

/// An object of a traced run, and the model that it is made again with.
struct TracedObject {
  std::string name;
  std::filesystem::path model;
  std::string checksum;  ///< of that file
  EngineKind engine = EngineKind::kModal;
};

/// The scene of a trace, ready to be made again.
struct TracedScene {
  std::vector<TracedObject> objects;
  SimulationConfig config;
  bool other_engine = false;          ///< than the run's own, for all objects
  std::vector<std::string> warnings;  ///< for people

  double dt() const { return config.objects.front().model->dt; }
  std::vector<std::string> names() const;
  /// "modal", or one word an object.
  std::string engine_words() const;
  /// In the settings of a recorded step: the engine that was asked for, if any.
  void choose_engine(Settings& settings) const noexcept;
};

/// Reads the scene of a trace and its models. A model is looked for beside the trace, in the
/// current folder and where the scene says, and has to be the very one that the trace names; one
/// that `models` gives may be another.
/// @param models FILE, or NAME=FILE for the object of that name
/// Throws Error.
TracedScene read_traced_scene(const std::filesystem::path& trace,
                              const std::vector<std::string>& models,
                              std::optional<EngineKind> engine);

}  // namespace irdm::replay
