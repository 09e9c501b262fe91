#pragma once

#include <filesystem>
#include <string>

#include "scene/scene_source.hpp"
#include "simulation/step/settings.hpp"

namespace irdm {

/// The text of a scene with other settings, for a file in `folder`: only what differs from the
/// scene's own is written, relative paths lead to the same files as before. Comments are lost.
/// Throws Error where the text is no scene.
/// @param initial settings that the scene begins with
std::string scene_text_with(const SceneSource& source, const Settings& initial,
                            const Settings& settings, const std::filesystem::path& folder);

/// Writes that into a new file NAME-1.toml, or the next number that is free, once it reads back as
/// it should; no file is replaced. Returns the file's name. Throws Error, and leaves nothing then.
std::string save_scene(const SceneSource& source, const Settings& initial, const Settings& settings,
                       const std::filesystem::path& folder);

}  // namespace irdm
