#pragma once

#include <filesystem>

#include "scene/scene_source.hpp"

namespace irdm {

/// A scene of one model file: one object with its modal response, else the dense or the compressed
/// one, a coupling of 300 N/m, no gravity. A floating one hangs on a soft tether, so that it does
/// not fly away. Throws Error.
SceneSource model_scene(const std::filesystem::path& path);

}  // namespace irdm
