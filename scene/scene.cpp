#include "scene/scene.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>
#include <vector>

#include "common/blackbox/black_box_file.hpp"
#include "common/config/input_file.hpp"
#include "common/config/range.hpp"
#include "common/error.hpp"
#include "common/hdf5/handle.hpp"
#include "common/model/model_file.hpp"
#include "common/number_text.hpp"
#include "common/secret/secret_file.hpp"
#include "scene/common_keys.hpp"
#include "scene/scenery_keys.hpp"
#include "simulation/step/default_fingertip.hpp"
#include "simulation/step/settings.hpp"

namespace irdm {
namespace {

ServerConfig read_server(TomlTable table, int styluses) {
  ServerConfig config;
  config.styluses = styluses;
  config.address = table.text("address", config.address);
  config.port = table.integer("port", 0, 65535, config.port);
  config.styluses = table.integer("styluses", 1, kMaxStyluses, config.styluses);
  config.deformation_rate =
      table.number("deformation_rate", between(1.0, 1000.0), config.deformation_rate);
  config.status_period = table.number("status_period", between(0.0, 3600.0), config.status_period);
  if (table.has("key_file")) config.key_file = table.path("key_file");
  config.udp = table.boolean("udp", config.udp);
  config.deformation_threads =
      table.integer("deformation_threads", 0, 64, config.deformation_threads);
  config.realtime =
      scheduling_from_word(table.choice("realtime", {"require", "prefer", "ignore"}, "prefer"));
  config.black_box = read_black_box(table);
  table.finish();
  return config;
}

std::string read_token(TomlTable& table, const std::string& key) {
  const std::string token = table.text(key, "");
  if (!token.empty() && !is_token(token)) {
    table.fail(key, "is not 16 to 128 printable ASCII characters without blanks",
               "give such a one, for instance from: openssl rand -hex 16");
  }
  return token;
}

// The file is read where viewers are served, not here: replay has no need of it.
// @param token the value of the key without _file
std::optional<std::filesystem::path> read_token_path(TomlTable& table, const std::string& key,
                                                     const std::string& token) {
  if (!table.has(key)) return std::nullopt;
  if (!token.empty()) table.fail(key, "is given beside the token itself", "give one of them");
  return table.path(key);
}

void read_tokens(TomlTable& table, ViewerConfig& config) {
  config.token = read_token(table, "token");
  config.token_file = read_token_path(table, "token_file", config.token);
  config.onlooker_token = read_token(table, "onlooker_token");
  config.onlooker_token_file = read_token_path(table, "onlooker_token_file", config.onlooker_token);
  if (!config.onlooker_token.empty() && config.token.empty() && !config.token_file) {
    table.fail("onlooker_token", "is set without a token", "set viewer.token_file or viewer.token");
  }
  // What is saved and recorded of a scene has no token, and must still be a scene.
  if (config.onlooker_token_file && !config.token_file) {
    table.fail("onlooker_token_file", "is set without viewer.token_file", "set that one, too");
  }
  if (!config.onlooker_token.empty() && config.onlooker_token == config.token) {
    table.fail("onlooker_token", "is the token itself", "give another one");
  }
}

// Reads the kind of tip, after its radius. `stylus.ball` is the default.
void read_shape(TomlTable& table, SimulationStylus& stylus) {
  stylus.ball = table.choice("shape", {"patch", "ball"}, stylus.ball ? "ball" : "patch") == "ball";
  if (!stylus.ball) return;
  if (table.has("reach")) {
    table.fail("reach", "is not for a ball, which grabs what it touches", "leave it out");
  }
  if (table.has("radius") && stylus.radius <= 0.0) {
    table.fail("radius", "of a ball is 0", "use more, or shape = \"patch\"");
  }
}

// @param radius of the first [[stylus]]; none: it names none
// @param ball whether that one has a ball
void read_viewer_stylus(TomlTable table, std::optional<double> radius, bool ball,
                        ViewerConfig& config) {
  SimulationStylus& stylus = config.stylus;
  stylus.ball = ball;
  config.default_radius = !radius && !table.has("radius");
  stylus.radius = table.number("radius", lab::kTipLength, radius.value_or(0.0));
  stylus.coupling_stiffness =
      table.number("coupling_stiffness", between(1.0, 1e5), stylus.coupling_stiffness);
  stylus.reach = table.number("reach", lab::kTipLength, stylus.reach);
  read_shape(table, stylus);
  if (stylus.ball && stylus.radius <= 0.0) config.default_radius = true;
  config.max_force = table.number("max_force", between(0.1, 100.0), config.max_force);
  table.finish();
}

// @param radius, ball as in read_viewer_stylus()
ViewerConfig read_viewer(TomlTable table, std::optional<double> radius, bool ball) {
  ViewerConfig config;
  config.enabled = table.boolean("enabled", config.enabled);
  config.address = table.text("address", config.address);
  config.port = table.integer("port", 0, 65535, config.port);
  read_tokens(table, config);
  if (table.has("recordings")) config.recordings = table.path("recordings");
  if (table.has("scenes")) config.scenes = table.path("scenes");
  config.mouse = table.boolean("mouse", config.mouse);
  read_viewer_stylus(table.table("stylus"), radius, ball, config);
  table.finish();
  return config;
}

WorldConfig read_world(TomlTable table) {
  WorldConfig config;
  config.gravity = read_vector(table, "gravity", lab::kGravity);
  config.bound = table.number("bound", between(0.1, 1000.0), config.bound);
  table.finish();
  return config;
}

ContactConfig read_contact(TomlTable table) {
  ContactConfig config;
  config.coupling_stiffness =
      table.number("coupling_stiffness", lab::kStiffness, config.coupling_stiffness);
  config.release_time = table.number("release_time", between(1e-3, 1.0), config.release_time);
  config.between_objects = table.boolean("between_objects", config.between_objects);
  config.self = table.boolean("self", config.self);
  config.samples = table.integer("samples", 16, 4096, config.samples);
  config.sleep_time = table.number("sleep_time", between(0.0, 60.0), config.sleep_time);
  table.finish();
  return config;
}

RigidDamping read_damping(TomlTable table) {
  RigidDamping damping;
  damping.linear = table.number("linear", lab::kDamping, damping.linear);
  damping.angular = table.number("angular", lab::kDamping, damping.angular);
  table.finish();
  return damping;
}

Tether read_tether(TomlTable table) {
  Tether tether;
  tether.stiffness = table.number("stiffness", lab::kStiffness, tether.stiffness);
  tether.angular_stiffness =
      table.number("angular_stiffness", lab::kStiffness, tether.angular_stiffness);
  table.finish();
  return tether;
}

std::optional<FloorConfig> read_floor(TomlTable& file) {
  if (!file.has("floor")) return std::nullopt;
  TomlTable table = file.table("floor");
  FloorConfig floor;
  floor.height = table.number("height", lab::kPlace, floor.height);
  floor.normal = read_normal(table);
  floor.friction = read_friction(table.table("friction"), floor.friction);
  table.finish();
  return floor;
}

SimulationStylus read_stylus(TomlTable table, const ContactConfig& contact) {
  SimulationStylus stylus;
  stylus.radius = table.number("radius", lab::kTipLength, stylus.radius);
  stylus.coupling_stiffness =
      table.number("coupling_stiffness", lab::kStiffness, contact.coupling_stiffness);
  stylus.reach = table.number("reach", lab::kTipLength, stylus.reach);
  stylus.max_force = table.number("max_force", between(0.1, kMostAppliedForce), stylus.max_force);
  read_shape(table, stylus);
  if (table.has("tool")) table.table("tool");  // read_tool()
  table.finish();
  return stylus;
}

ResponseKind read_engine(TomlTable& table) {
  const std::string word = table.choice("engine", {"modal", "dense", "compressed"}, "modal");
  if (word == "dense") return ResponseKind::kDense;
  return word == "compressed" ? ResponseKind::kCompressed : ResponseKind::kModal;
}

ObjectConfig read_object(TomlTable table) {
  ObjectConfig config;
  config.name = read_name(table, config.name);
  config.model = table.path("model");
  config.engine = read_engine(table);
  config.position = read_vector(table, "position", lab::kPlace);
  config.orientation = read_orientation(table);
  config.velocity = read_vector(table, "velocity", lab::kVelocity);
  config.angular_velocity = read_vector(table, "angular_velocity", lab::kAngularVelocity);
  config.friction = read_friction(table.table("friction"), config.friction);
  config.damping = read_damping(table.table("damping"));
  config.tether = read_tether(table.table("tether"));
  config.inertial_loading = table.boolean("inertial_loading", config.inertial_loading);
  config.material_damping =
      table.number("material_damping", lab::kMaterialDamping, config.material_damping);
  if (table.has("switchable")) {
    table.fail("switchable", "is not a key any more",
               "leave it out; irdm-replay --engine compares the engines on a recorded run");
  }
  if (table.has("memory_budget")) {
    config.memory_budget = table.number("memory_budget", between(1.0, 1e8), 0.0);
    if (config.engine != ResponseKind::kDense) {
      table.fail("memory_budget", "is for the engine \"dense\"",
                 "leave it out, or set engine = \"dense\"");
    }
  }
  table.finish();
  return config;
}

CouplingConstants read_coupling(TomlTable& table) {
  const auto constant = [&](const char* key) -> std::optional<double> {
    if (!table.has(key)) return std::nullopt;
    return table.number(key, lab::kStiffness);
  };
  return {constant("stiffness"), constant("damping"), constant("angular_stiffness"),
          constant("angular_damping")};
}

// Of a stylus that has one, when the objects are known. @param taken that other styluses lead
void read_tool(TomlTable table, const std::vector<ObjectConfig>& objects, std::set<int>& taken,
               SimulationStylus& stylus) {
  for (const char* key : {"radius", "shape", "coupling_stiffness", "reach"}) {
    if (table.has(key)) table.fail(key, "is nothing to a stylus that leads a tool", "leave it out");
  }
  TomlTable tool = table.table("tool");
  const std::string name = tool.text("object");
  const auto object =
      std::find_if(objects.begin(), objects.end(),
                   [&](const ObjectConfig& candidate) { return candidate.name == name; });
  if (object == objects.end()) {
    tool.fail("object", "is no object of the scene: " + in_quotes(name),
              "give the name of an [[object]]");
  }
  const int number = static_cast<int>(object - objects.begin());
  if (!taken.insert(number).second) {
    tool.fail("object", "is led by another stylus: " + in_quotes(name),
              "give each stylus a tool of its own");
  }
  stylus.tool = ToolCoupling{number, read_coupling(tool)};
  tool.finish();
}

}  // namespace

SceneConfig read_scene(TomlTable file) {
  SceneConfig scene;
  scene.world = read_world(file.table("world"));
  scene.contact = read_contact(file.table("contact"));
  scene.floor = read_floor(file);
  const std::vector<TomlTable> styluses = file.tables("stylus");
  for (const TomlTable& stylus : styluses) {
    scene.styluses.push_back(read_stylus(stylus, scene.contact));
  }
  const int described = static_cast<int>(scene.styluses.size());
  if (described > kMaxStyluses) {
    file.fail("stylus", "appears too often", "use at most " + std::to_string(kMaxStyluses));
  }
  scene.server = read_server(file.table("server"), std::max(1, described));
  if (scene.server.styluses < described) {
    file.fail("server", "has fewer styluses than there are [[stylus]] tables",
              "raise server.styluses or leave it out");
  }
  scene.styluses.resize(static_cast<std::size_t>(scene.server.styluses),
                        {0.0, scene.contact.coupling_stiffness, 0.0});
  for (std::size_t s = 0; s < scene.styluses.size(); ++s) {
    const bool named =
        s < styluses.size() && (styluses[s].has("radius") || styluses[s].has("tool"));
    if (!named) scene.default_radius.push_back(s);
  }
  const bool named = !styluses.empty() && styluses.front().has("radius");
  scene.viewer = read_viewer(file.table("viewer"),
                             named ? std::optional(scene.styluses.front().radius) : std::nullopt,
                             scene.styluses.front().ball);
  std::set<std::string> names;
  for (TomlTable& object : file.tables("object")) {
    scene.objects.push_back(read_object(object));
    if (!names.insert(scene.objects.back().name).second) {
      file.fail("object", "appears twice with the name " + in_quotes(scene.objects.back().name),
                "give each object a name of its own");
    }
  }
  if (scene.objects.empty()) file.fail("object", "is missing", "add [[object]] with a model");
  if (scene.objects.size() > kMaxObjects) {
    file.fail("object", "appears too often", "use at most " + std::to_string(kMaxObjects));
  }
  std::set<int> led;
  for (std::size_t s = 0; s < styluses.size(); ++s) {
    if (styluses[s].has("tool")) read_tool(styluses[s], scene.objects, led, scene.styluses[s]);
  }
  for (TomlTable& table : file.tables("scenery")) {
    scene.scenery.push_back(read_scenery(table, scene.scenery_models.emplace_back()));
    if (!names.insert(scene.scenery.back().name).second) {
      table.fail("name", "is taken: " + in_quotes(scene.scenery.back().name),
                 "give each object and each scenery a name of its own");
    }
  }
  if (scene.scenery.size() > kMaxScenery) {
    file.fail("scenery", "appears too often", "use at most " + std::to_string(kMaxScenery));
  }
  file.finish();
  return scene;
}

std::string read_text(const std::filesystem::path& path) {
  require_file(path, kMostConfigBytes);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw Error(path.string(), "cannot be read", "check the path and its permissions");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

namespace {

constexpr double kBytesAMebibyte = 1024.0 * 1024.0;

Model read_by_budget(const ObjectConfig& object, SceneColumns* columns) {
  if (object.engine != ResponseKind::kDense || !object.memory_budget || columns == nullptr) {
    const std::lock_guard lock(hdf5::library_mutex());
    return read_model(object.model, object.engine);
  }
  return columns->read(object.model,
                       static_cast<std::size_t>(*object.memory_budget * kBytesAMebibyte));
}

/// The models of a scene's objects: those of one file and kind have the same, but where it has a
/// budget of memory, which is each object's own.
class Models {
 public:
  explicit Models(SceneColumns* columns) : columns_(columns) {}

  std::shared_ptr<const Model> of(const ObjectConfig& object) {
    std::shared_ptr<const Model> model = find(object);
    if (!model) {
      model = std::make_shared<const Model>(read_by_budget(object, columns_));
      if (!object.memory_budget) read_.push_back({object.model, object.engine, model});
    }
    check_inertial_loading(*model, object.inertial_loading, object.model.string());
    return model;
  }

 private:
  struct Read {
    std::filesystem::path file;
    ResponseKind kind;
    std::shared_ptr<const Model> model;
  };

  std::shared_ptr<const Model> find(const ObjectConfig& object) const {
    if (object.memory_budget) return nullptr;
    for (const Read& read : read_) {
      if (read.kind == object.engine && read.file == object.model) return read.model;
    }
    return nullptr;
  }

  SceneColumns* columns_;
  std::vector<Read> read_;
};

MeshShape read_mesh_of(const std::filesystem::path& model) {
  const std::lock_guard lock(hdf5::library_mutex());
  return read_mesh_shape(model);
}

// The scenery of a scene, with the surfaces of its meshes.
std::vector<SceneryConfig> whole_scenery(const SceneConfig& scene) {
  std::vector<SceneryConfig> scenery = scene.scenery;
  std::map<std::filesystem::path, MeshShape> read;
  for (std::size_t i = 0; i < scenery.size(); ++i) {
    if (!std::holds_alternative<MeshShape>(scenery[i].shape)) continue;
    MeshShape& mesh = read[scene.scenery_models.at(i)];
    if (!mesh.surface) mesh = read_mesh_of(scene.scenery_models.at(i));
    scenery[i].shape = mesh;
  }
  return scenery;
}

}  // namespace

bool has_viewer_stylus(const SceneConfig& scene, bool lockstep) {
  return scene.viewer.enabled && scene.viewer.mouse && !lockstep &&
         scene.styluses.size() < kMaxStyluses;
}

bool recorded_viewer_stylus(const SceneConfig& scene, int stylus_count, const std::string& trace) {
  const int more = stylus_count - static_cast<int>(scene.styluses.size());
  if (more == 0 || more == 1) return more == 1;
  throw Error(trace,
              "has " + styluses_text(static_cast<std::size_t>(stylus_count)) + ", the scene " +
                  std::to_string(scene.styluses.size()),
              "give the scene that it was recorded with");
}

namespace {

// Of the styluses that name none.
void set_default_radius(const SceneConfig& scene, bool viewer_stylus, SimulationConfig& config) {
  const bool of_viewer = viewer_stylus && scene.viewer.default_radius;
  if (scene.default_radius.empty() && !of_viewer) return;
  const double radius = default_fingertip(config);
  const double ball = default_ball_radius(config);
  const auto set = [&](SimulationStylus& stylus) { stylus.radius = stylus.ball ? ball : radius; };
  for (const std::size_t s : scene.default_radius) set(config.styluses[s]);
  if (of_viewer) set(config.styluses.back());
}

}  // namespace

SimulationConfig simulation_config(const SceneConfig& scene, bool viewer_stylus,
                                   SceneColumns* columns) {
  Models models(columns);
  SimulationConfig config;
  config.gravity = scene.world.gravity;
  for (const ObjectConfig& object : scene.objects) {
    config.objects.push_back({models.of(object), object.position, object.orientation,
                              object.velocity, object.angular_velocity, object.friction,
                              object.damping, object.tether, object.inertial_loading, object.name,
                              object.material_damping});
  }
  config.styluses = scene.styluses;
  if (viewer_stylus) config.styluses.push_back(scene.viewer.stylus);
  set_default_radius(scene, viewer_stylus, config);
  config.floor = scene.floor;
  config.release_time = scene.contact.release_time;
  config.scenery = whole_scenery(scene);
  config.between_objects = scene.contact.between_objects;
  config.self_contact = scene.contact.self;
  config.contact_samples = scene.contact.samples;
  config.sleep_time = scene.contact.sleep_time;
  check_material_damping(config);
  return config;
}

}  // namespace irdm
