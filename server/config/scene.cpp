#include "server/config/scene.hpp"

#include <fstream>
#include <sstream>

#include "common/error.hpp"

namespace irdm {
namespace {

constexpr Range kAnyNumber;

Vector3 read_vector(TomlTable& table, const std::string& key) {
  return Vector3(table.numbers(key, 3, kAnyNumber, {0.0, 0.0, 0.0}).data());
}

ServerConfig read_server(TomlTable table) {
  ServerConfig config;
  config.address = table.text("address", config.address);
  config.port = table.integer("port", 0, 65535, config.port);
  config.styluses = table.integer("styluses", 1, kMaxStyluses, config.styluses);
  config.deformation_rate =
      table.number("deformation_rate", between(1.0, 1000.0), config.deformation_rate);
  config.deformation_threads =
      table.integer("deformation_threads", 0, 64, config.deformation_threads);
  config.realtime =
      scheduling_from_word(table.choice("realtime", {"require", "prefer", "ignore"}, "prefer"));
  table.finish();
  return config;
}

WorldConfig read_world(TomlTable table) {
  WorldConfig config;
  config.gravity = read_vector(table, "gravity");
  table.finish();
  return config;
}

ContactConfig read_contact(TomlTable table) {
  ContactConfig config;
  config.coupling_stiffness =
      table.number("coupling_stiffness", at_least(0.0), config.coupling_stiffness);
  table.finish();
  return config;
}

Quaternion read_orientation(TomlTable& table) {
  const auto wxyz = table.numbers("orientation", 4, kAnyNumber, {1.0, 0.0, 0.0, 0.0});
  const Quaternion orientation(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  constexpr double kSmallest = 1e-6;
  if (orientation.norm() < kSmallest) {
    table.fail("orientation", "has no length",
               "give a quaternion w, x, y, z, for instance [1, 0, 0, 0]");
  }
  return orientation.normalized();
}

ObjectConfig read_object(TomlTable table) {
  ObjectConfig config;
  config.name = table.text("name", config.name);
  config.model = table.path("model");
  config.engine = table.choice("engine", {"modal", "dense"}, "modal") == "dense"
                      ? EngineKind::kDense
                      : EngineKind::kModal;
  config.position = read_vector(table, "position");
  config.orientation = read_orientation(table);
  config.velocity = read_vector(table, "velocity");
  config.angular_velocity = read_vector(table, "angular_velocity");
  table.finish();
  return config;
}

}  // namespace

SceneConfig read_scene(TomlTable file) {
  SceneConfig scene;
  scene.server = read_server(file.table("server"));
  scene.world = read_world(file.table("world"));
  scene.contact = read_contact(file.table("contact"));
  for (TomlTable& object : file.tables("object")) scene.objects.push_back(read_object(object));
  if (scene.objects.empty()) file.fail("object", "is missing", "add [[object]] with a model");
  if (scene.objects.size() > 1) {
    file.fail("object", "appears more than once", "this version plays one object a scene");
  }
  file.finish();
  return scene;
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(path.string(), "cannot be read", "check the path and its permissions");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace irdm
