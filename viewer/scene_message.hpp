#pragma once

#include "scene/scene.hpp"
#include "viewer/message.hpp"
#include "viewer/viewer_server.hpp"

namespace irdm {

/// What viewers are told of a scene at first: of one that is looked at, without a stylus of theirs.
/// @param names of its objects
viewer::Scene viewer_scene(const std::vector<std::string>& names, const SimulationConfig& config);

/// Reads the files of tokens into the tokens. Throws Error.
void load_tokens(ViewerConfig& config);

/// Where and for whom the viewer listens, with the page that was built with this program.
/// @param config with its tokens loaded
viewer::ViewerSettings viewer_settings(const ViewerConfig& config);

/// The choices that viewers have for each object.
std::vector<SettingsChoice> settings_choices(const SimulationConfig& config);

}  // namespace irdm
