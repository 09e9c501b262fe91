#include "scene/scene_source.hpp"

namespace irdm {

SceneSource read_scene_source(const std::filesystem::path& path) {
  return {path.string(), read_text(path), std::filesystem::absolute(path).parent_path()};
}

SceneConfig read_scene(const SceneSource& source) {
  return read_scene(TomlTable::parse_text(source.text, source.name, source.folder));
}

}  // namespace irdm
