#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/blackbox/black_box.hpp"
#include "common/config/toml_reader.hpp"
#include "common/model/model_file.hpp"
#include "common/realtime/scheduling.hpp"
#include "scene/columns/column_store.hpp"
#include "simulation/step/simulation_config.hpp"
#include "simulation/step/step_record.hpp"

namespace irdm {

/// [server]
struct ServerConfig {
  std::string address = "127.0.0.1";  ///< to listen on
  int port = 0;                       ///< 0..65535; 0: any free one
  int styluses =
      1;  ///< how many styluses take part, 1..kMaxStyluses; default: the [[stylus]] tables
  double deformation_rate = 60.0;  ///< deformed surfaces a second, 1..1000 [Hz]
  RealTimeScheduling realtime = RealTimeScheduling::kPrefer;  ///< "require" | "prefer" | "ignore"
  double status_period = 10.0;  ///< of status lines in the log, 0..3600 [s]; 0: none
  std::optional<std::filesystem::path> key_file;  ///< none: the address is a loopback one
  bool udp = true;  ///< bridges that want to may send and take their stream by datagrams
  /// black_box: a folder, "" for none; black_box_files: 1..1000
  BlackBoxSettings black_box = {};
  int deformation_threads = 0;  ///< OpenMP threads for them, 0..64; 0: all cores but one
};

/// [viewer]
struct ViewerConfig {
  bool enabled = true;                ///< whether irdm-server shows its objects to browsers
  std::string address = "127.0.0.1";  ///< to listen on
  int port = 0;                       ///< 0..65535; 0: any free one
  std::string token;           ///< what a viewer has to know, 0 or 16..128 printable characters
  std::string onlooker_token;  ///< the same for viewers that may only look on
  /// Files that hold them in place of the keys above (read_token_file()); none: no file
  std::optional<std::filesystem::path> token_file;
  std::optional<std::filesystem::path> onlooker_token_file;
  std::optional<std::filesystem::path>
      recordings;  ///< folder for what viewers record; none: they cannot
  /// Folder of scenes and models that viewers may load, and save into; none: they cannot
  std::optional<std::filesystem::path> scenes;
  bool mouse = true;  ///< whether viewers have a stylus of their own; never in lockstep
  /// stylus = { radius, coupling_stiffness, reach }: that one; radius by default that of the first
  /// [[stylus]]
  SimulationStylus stylus{0.0, 300.0, 0.01};
  bool default_radius = true;  ///< it names none, and neither does the first [[stylus]]
  double max_force = 3.3;  ///< stylus = { max_force }: it pushes with at most this [N], 0.1..100
};

/// [world]
struct WorldConfig {
  Vector3 gravity = Vector3::Zero();  ///< [m/s^2], W
  /// Positions of styluses with a component beyond it are not used, 0.1..1000 [m], W.
  double bound = 10.0;
};

/// [contact]
struct ContactConfig {
  /// k_vc of styluses that do not say otherwise, >= 0 [N/m]; 0: none, which a fixed object is
  /// refused with
  double coupling_stiffness = 0.0;
  double release_time = 0.03;   ///< in which a held point that pulls is given up, 0.001..1 [s]
  bool between_objects = true;  ///< whether objects touch each other and scenery
  bool self = false;            ///< whether parts of one object touch each other
  int samples = 384;            ///< patches of an object's surface for such contacts, 16..4096
  double sleep_time = 0.5;      ///< at rest, after which objects sleep, 0..60 [s]; 0: never
};

/// [[object]]
struct ObjectConfig {
  std::string name = "object";
  std::filesystem::path model;  ///< required
  ResponseKind engine = ResponseKind::kModal;
  Vector3 position = Vector3::Zero();               ///< of the centre of mass [m], W
  Quaternion orientation = Quaternion::Identity();  ///< w x y z, normalised when read
  Vector3 velocity = Vector3::Zero();               ///< [m/s], W
  Vector3 angular_velocity = Vector3::Zero();       ///< [rad/s], W
  Friction friction{0.6, 0.5};    ///< friction = { static, kinetic }, 0 <= kinetic <= static <= 10
  RigidDamping damping;           ///< damping = { linear, angular }
  Tether tether;                  ///< tether = { stiffness, angular_stiffness }
  bool inertial_loading = false;  ///< centrifugal loading by its own spin
  double material_damping = 1.0;  ///< times the model's, 0.1..10; modal response, no floor
  /// Of its dense response in memory [MiB], at least 1; none: all of it
  std::optional<double> memory_budget = {};
};

/// What irdm-server is to run.
struct SceneConfig {
  std::optional<FloorConfig> floor;  ///< [floor] height [m], normal, friction = { static, kinetic }
  ServerConfig server;
  ViewerConfig viewer;
  WorldConfig world;
  ContactConfig contact;
  std::vector<SimulationStylus> styluses;             ///< [[stylus]], one for every slot
  std::vector<std::size_t> default_radius;            ///< those of them that name no radius
  std::vector<ObjectConfig> objects;                  ///< 1..kMaxObjects
  std::vector<SceneryConfig> scenery;                 ///< [[scenery]], at most kMaxScenery
  std::vector<std::filesystem::path> scenery_models;  ///< of each; empty: it is no mesh
};

/// Reads and checks a scene. Throws Error with file and line.
SceneConfig read_scene(TomlTable file);

/// The whole text of a file. Throws Error.
std::string read_text(const std::filesystem::path& path);

/// Whether viewers get a stylus of their own, which comes after those of the scene.
bool has_viewer_stylus(const SceneConfig& scene, bool lockstep);

/// Whether a trace of so many styluses has that of the viewers. Throws Error, naming the trace,
/// when it is not of this scene.
bool recorded_viewer_stylus(const SceneConfig& scene, int stylus_count, const std::string& trace);

/// What a scene asks to simulate, with its models read; styluses without a radius have that of
/// default_fingertip(). Throws Error. Holds hdf5::library_mutex() while it reads a file.
/// @param columns of models with a memory_budget, to be started then; null: they are read whole
SimulationConfig simulation_config(const SceneConfig& scene, bool viewer_stylus,
                                   SceneColumns* columns = nullptr);

}  // namespace irdm
