#pragma once

#include <filesystem>
#include <string>

#include "scene/scene_source.hpp"
#include "simulation/step/settings.hpp"

namespace irdm {

/// The text of a scene with other settings, for a file in `folder`: only what differs from the
/// scene's own is written, relative paths lead to the same files as before. Comments are lost, and
/// the viewer's tokens are left out. Throws Error where the text is no scene.
/// @param initial settings that the scene begins with
std::string scene_text_with(const SceneSource& source, const Settings& initial,
                            const Settings& settings, const std::filesystem::path& folder);

/// Returns the text of a scene with the values of viewer.token and viewer.onlooker_token emptied,
/// all else to the byte: for traces, which are passed on. The text must be a valid scene.
std::string without_secrets(const SceneSource& source);

/// Writes that into a new file NAME-1.toml, or the next number that is free, once it reads back as
/// it should; no file is replaced. Returns the file's name. Throws Error, and leaves nothing then.
std::string save_scene(const SceneSource& source, const Settings& initial, const Settings& settings,
                       const std::filesystem::path& folder);

}  // namespace irdm
