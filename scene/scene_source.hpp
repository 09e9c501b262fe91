#pragma once

#include <filesystem>
#include <string>

#include "scene/scene.hpp"

namespace irdm {

/// The text of a scene, and where it is from.
struct SceneSource {
  std::string name;              ///< of its file, in messages
  std::string text;              ///< TOML
  std::filesystem::path folder;  ///< that relative paths in it begin at
};

/// Throws Error.
SceneSource read_scene_source(const std::filesystem::path& path);

/// Reads and checks the scene of a text. Throws Error with file and line.
SceneConfig read_scene(const SceneSource& source);

}  // namespace irdm
