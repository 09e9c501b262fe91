#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/scene_source.hpp"

/// A folder of scenes to choose from.
namespace irdm {

inline constexpr std::size_t kMostScenes = 200;        ///< that are listed
inline constexpr std::size_t kLongestSceneName = 128;  ///< of those that are listed [bytes]

/// Names of the files directly in a folder that are scenes (*.toml with an [[object]]) or may be
/// models (*.h5), sorted, the first kMostScenes. Hidden ones, and names with control characters are
/// left out. A folder that cannot be read has none.
std::vector<std::string> scenes_in(const std::filesystem::path& folder);

/// The scene of that name; of a model, the one that model_scene() makes. Throws Error, also where
/// the name is not listed.
SceneSource scene_in(const std::filesystem::path& folder, const std::string& name);

}  // namespace irdm
