#include "scene/scene_folder.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include "common/error.hpp"
#include "common/utf8.hpp"
#include "scene/model_scene.hpp"

namespace irdm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostEntries = 10'000;    // of a folder that are looked at
constexpr std::size_t kMostLookedAt = 1 << 16;  // bytes of a file, for an object

bool is_listable(const std::string& name) {
  const bool plain = std::none_of(name.begin(), name.end(), [](char letter) {
    const auto code = static_cast<unsigned char>(letter);
    return code < 0x20 || code == 0x7F;
  });
  return plain && is_utf8(name) && name.size() <= kLongestSceneName && name.front() != '.';
}

// Also where it is no TOML: what is wrong is then said when it is loaded.
bool has_object(const fs::path& path) {
  std::string text(kMostLookedAt, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::erase_if(line, [](char letter) { return letter == ' ' || letter == '\t'; });
    if (line.starts_with("[[object]]") || line.starts_with("object=")) return true;
  }
  return false;
}

bool is_scene(const fs::directory_entry& entry) {
  std::error_code failure;
  if (!is_listable(entry.path().filename().string())) return false;
  const fs::path ending = entry.path().extension();
  if (ending != ".toml" && ending != ".h5") return false;
  if (!entry.is_regular_file(failure) || failure) return false;
  return ending == ".h5" || has_object(entry.path());
}

}  // namespace

std::vector<std::string> scenes_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  fs::directory_iterator entry(folder, failure);
  for (std::size_t i = 0; !failure && entry != fs::directory_iterator() && i < kMostEntries; ++i) {
    if (is_scene(*entry)) names.push_back(entry->path().filename().string());
    entry.increment(failure);
  }
  std::sort(names.begin(), names.end());
  if (names.size() > kMostScenes) names.resize(kMostScenes);
  return names;
}

SceneSource scene_in(const fs::path& folder, const std::string& name) {
  const std::vector<std::string> names = scenes_in(folder);
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw Error(shortened(name), "is not among the scenes any more", "choose another one");
  }
  const fs::path path = folder / name;
  return path.extension() == ".h5" ? model_scene(path) : read_scene_source(path);
}

}  // namespace irdm
