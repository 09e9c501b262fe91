#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/model/model_file.hpp"
#include "simulation/step/simulation_config.hpp"

namespace irdm::replay {

/// An object of a traced run, and the model that it is rerun with.
struct TracedObject {
  std::string name;
  std::filesystem::path model;
  std::string checksum;  ///< of that file
  ResponseKind engine = ResponseKind::kModal;
};

/// The scene of a trace, ready to be rerun.
struct TracedScene {
  std::vector<TracedObject> objects;
  SimulationConfig config;
  std::vector<std::string> warnings;  ///< for people

  double dt() const { return config.objects.front().model->dt; }
  std::vector<std::string> names() const;
  /// "modal", or one word an object.
  std::string engine_words() const;
};

/// Reads the scene of a trace and its models. A model is looked for beside the trace, in the
/// current folder and where the scene says, and has to be the very one that the trace names; one
/// that `models` gives may be another.
/// @param models FILE, or NAME=FILE for the object of that name
/// Throws Error.
TracedScene read_traced_scene(const std::filesystem::path& trace,
                              const std::vector<std::string>& models,
                              std::optional<ResponseKind> engine);

}  // namespace irdm::replay
