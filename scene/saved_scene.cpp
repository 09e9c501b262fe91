#include "scene/saved_scene.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <sstream>
#include <utility>
#include <vector>

#include "common/error.hpp"
#include "scene/new_file.hpp"

namespace irdm {
namespace {

namespace fs = std::filesystem;

/// Makes relative paths of a scene begin at another folder.
class Paths {
 public:
  Paths(const fs::path& from, const fs::path& to)
      : from_(fs::weakly_canonical(from)), to_(fs::weakly_canonical(fs::absolute(to))) {}

  void move(toml::table* table, const char* key) const {
    if (table == nullptr || from_ == to_) return;
    const auto text = (*table)[key].value<std::string>();
    if (!text || text->empty() || fs::path(*text).is_absolute()) return;
    const fs::path file = from_ / *text;
    const fs::path moved = file.lexically_relative(to_);
    table->insert_or_assign(key, (moved.empty() ? file : moved).string());
  }
  void move_each(toml::array* tables, const char* inside, const char* key) const {
    if (tables == nullptr) return;
    for (toml::node& node : *tables) {
      toml::table* table = node.as_table();
      if (table != nullptr && inside != nullptr) table = (*table)[inside].as_table();
      move(table, key);
    }
  }

 private:
  fs::path from_, to_;
};

void move_paths(toml::table& scene, const Paths& paths) {
  for (const char* key : {"key_file", "black_box"}) paths.move(scene["server"].as_table(), key);
  for (const char* key : {"recordings", "scenes", "token_file", "onlooker_token_file"}) {
    paths.move(scene["viewer"].as_table(), key);
  }
  paths.move_each(scene["object"].as_array(), nullptr, "model");
  paths.move_each(scene["scenery"].as_array(), "mesh", "model");
}

void put(toml::table& object, const char* key, const char* first, double value, const char* second,
         double other) {
  toml::table pair{{first, value}, {second, other}};
  pair.is_inline(true);
  object.insert_or_assign(key, std::move(pair));
}

void change_object(toml::table& object, const ObjectSettings& initial,
                   const ObjectSettings& settings) {
  const auto& [friction, damping, tether, material_damping, inertial_loading] = settings;
  if (friction != initial.friction) {
    put(object, "friction", "static", friction.static_, "kinetic", friction.kinetic);
  }
  if (damping != initial.damping) {
    put(object, "damping", "linear", damping.linear, "angular", damping.angular);
  }
  if (tether != initial.tether) {
    put(object, "tether", "stiffness", tether.stiffness, "angular_stiffness",
        tether.angular_stiffness);
  }
  if (material_damping != initial.material_damping) {
    object.insert_or_assign("material_damping", material_damping);
  }
  if (inertial_loading != initial.inertial_loading) {
    object.insert_or_assign("inertial_loading", inertial_loading);
  }
}

void change_gravity(toml::table& scene, const Vector3& gravity) {
  if (!scene.contains("world")) scene.insert("world", toml::table{});
  toml::table* world = scene["world"].as_table();
  world->insert_or_assign("gravity", toml::array{gravity.x(), gravity.y(), gravity.z()});
}

constexpr std::array<const char*, 2> kSecretKeys{"token", "onlooker_token"};

// Returns the byte offset of a position of toml++, which counts lines and UTF-8 characters from 1.
std::size_t offset(const std::string& text, const toml::source_position& position) {
  std::size_t at = 0;
  for (toml::source_index line = 1; line < position.line; ++line) at = text.find('\n', at) + 1;
  if (at == 0 && text.starts_with("\xEF\xBB\xBF")) at = 3;
  const auto continues = [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0) == 0x80;
  };
  for (toml::source_index column = 1; column < position.column && at < text.size(); ++column) {
    do ++at;
    while (at < text.size() && continues(text[at]));
  }
  return std::min(at, text.size());
}

toml::table parse(const SceneSource& source) {
  read_scene(source);  // so that what is wrong with it is said with its line
  return toml::parse(source.text);
}

// Without the number that an earlier saving added.
std::string stem_of(const SceneSource& source) {
  constexpr std::size_t kLongest = 100;
  constexpr std::size_t kDigits = 3;
  std::string stem = fs::path(source.name).stem().string();
  const std::size_t dash = stem.rfind('-');
  const bool numbered =
      dash != std::string::npos && dash > 0 && dash + 1 < stem.size() &&
      stem.size() - dash - 1 <= kDigits &&
      std::all_of(stem.begin() + static_cast<std::ptrdiff_t>(dash) + 1, stem.end(),
                  [](unsigned char letter) { return std::isdigit(letter) != 0; });
  if (numbered) stem.resize(dash);
  if (stem.empty() || stem.size() > kLongest || stem.front() == '.') return "scene";
  return stem;
}

bool same_file(const fs::path& a, const fs::path& b) {
  return fs::weakly_canonical(a) == fs::weakly_canonical(b);
}

bool holds(const ObjectConfig& object, const ObjectSettings& settings, const fs::path& model) {
  return same_file(object.model, model) && object.friction == settings.friction &&
         object.damping == settings.damping && object.tether == settings.tether &&
         object.material_damping == settings.material_damping &&
         object.inertial_loading == settings.inertial_loading;
}

void check_saved(const SceneSource& saved, const SceneSource& source, const Settings& settings) {
  const SceneConfig before = read_scene(source);
  const SceneConfig after = read_scene(saved);
  bool whole =
      after.world.gravity == settings.gravity && after.objects.size() == before.objects.size();
  for (std::size_t i = 0; whole && i < after.objects.size(); ++i) {
    whole = holds(after.objects[i], settings.object.at(i), before.objects[i].model);
  }
  if (whole) return;
  throw Error(saved.name, "would not hold these settings", "write them into a scene by hand");
}

}  // namespace

std::string scene_text_with(const SceneSource& source, const Settings& initial,
                            const Settings& settings, const fs::path& folder) {
  toml::table scene = parse(source);
  move_paths(scene, Paths(source.folder, folder));
  if (settings.gravity != initial.gravity) change_gravity(scene, settings.gravity);
  toml::array& objects = *scene["object"].as_array();
  for (std::size_t i = 0; i < objects.size() && i < settings.object.size(); ++i) {
    change_object(*objects[i].as_table(), initial.object[i], settings.object[i]);
  }
  // A file that others may read holds no secret.
  if (toml::table* viewer = scene["viewer"].as_table()) {
    for (const char* key : kSecretKeys) viewer->erase(key);
  }
  std::ostringstream text;
  text << scene << '\n';
  return text.str();
}

std::string without_secrets(const SceneSource& source) {
  std::string text = source.text;
  const toml::table scene = toml::parse(source.text);
  const toml::table* viewer = scene["viewer"].as_table();
  if (viewer == nullptr) return text;
  std::vector<std::pair<std::size_t, std::size_t>> places;  // from, to
  for (const char* key : kSecretKeys) {
    const toml::node* node = viewer->get(key);
    if (node == nullptr) continue;
    places.emplace_back(offset(text, node->source().begin), offset(text, node->source().end));
  }
  std::ranges::sort(places, std::greater<>());  // the last first, so that the others stay
  for (const auto& [from, to] : places) text.replace(from, to - from, "\"\"");
  return text;
}

std::string save_scene(const SceneSource& source, const Settings& initial, const Settings& settings,
                       const fs::path& folder) {
  const std::string stem = stem_of(source);
  const std::string text = scene_text_with(source, initial, settings, folder);
  check_saved({(folder / (stem + ".toml")).string(), text, fs::absolute(folder)}, source, settings);
  return write_new_file(folder, stem, ".toml", text);
}

}  // namespace irdm
