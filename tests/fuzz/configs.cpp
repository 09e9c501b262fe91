// The TOML files of the three programs. What is wrong with a file is told by irdm::Error in one
// line.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/error.hpp"
#include "device_bridge/bridge_config.hpp"
#include "precompute/config.hpp"
#include "scene/scene.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/scratch_file.hpp"

namespace irdm::fuzz {
namespace {

constexpr double kRounding = 1e-9;

void expect_unit(double norm, const char* what) {
  expect(std::abs(norm - 1.0) < kRounding, what);
}

/// A file with this text; without any there is no file.
std::filesystem::path file_with(Input input) {
  std::filesystem::path path = scratch_file("it.toml", text_of(input));
  if (input.empty()) std::filesystem::remove(path);
  return path;
}

template <typename Read>
void try_to(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    const std::string_view line = error.what();
    expect(std::none_of(line.begin(), line.end(),
                        [](unsigned char c) { return c < 0x20 || c == 0x7F; }),
           "an error is one line without control characters");
  }
}

void check_scene(const SceneConfig& scene) {
  if (scene.floor) expect_unit(scene.floor->normal.norm(), "the floor's normal has length 1");
  for (const ObjectConfig& object : scene.objects) {
    expect_unit(object.orientation.norm(), "an orientation has norm 1");
    expect(object.friction.kinetic <= object.friction.static_, "kinetic <= static");
    expect(object.position.allFinite() && object.velocity.allFinite(), "motion is finite");
  }
  for (const SceneryConfig& scenery : scene.scenery) {
    expect_unit(scenery.orientation.norm(), "an orientation has norm 1");
    expect(scenery.friction.kinetic <= scenery.friction.static_, "kinetic <= static");
    if (std::holds_alternative<MeshShape>(scenery.shape)) continue;  // which has to be read
    expect(bounding_radius(scenery.shape) > 0.0, "scenery has a size");
  }
  expect(scene.scenery.size() <= kMaxScenery, "at most 16 scenery");
  expect(scene.scenery_models.size() == scene.scenery.size(), "each scenery may have a model");
  expect(!scene.styluses.empty() && scene.styluses.size() <= kMaxStyluses, "1 to 16 styluses");
}

void check_bridge(const BridgeConfig& config) {
  expect(!config.server || (!config.server->host.empty() && config.server->port > 0),
         "a server has host and port");
  for (const DeviceConfig& device : config.devices) {
    expect_unit(device.mapping.workspace.rotation.norm(), "a rotation has norm 1");
  }
}

}  // namespace

// As irdm-server reads it, and as irdm-replay does out of a trace.
void scene_config(Input input) {
  const std::filesystem::path path = file_with(input);
  try_to([&] { check_scene(read_scene(TomlTable::parse_file(path))); });
  try_to([&] { check_scene(read_scene(TomlTable::parse_text(read_text(path), "trace.h5"))); });
}

void precompute_config(Input input) {
  const std::filesystem::path path = file_with(input);
  try_to([&] {
    using namespace precompute;
    const PrecomputeConfig config = load_config(path);
    if (config.rigid) return;  // nothing is stepped
    const int intervals = std::min(config.response.steps, 20);
    for (const int count : step_schedule(config.time_stepping, config.response.dt, intervals)) {
      expect(count >= 1, "every interval has a step");
    }
    if (const auto* box = std::get_if<BoxConfig>(&config.mesh.source)) {
      expect((box->size.array() > 0.0).all(), "a box has a size");
    }
  });
}

// Alone, and with what a command line may say beside it.
void bridge_config(Input input) {
  const std::filesystem::path path = file_with(input);
  try_to([&] { check_bridge(load_bridge_config(path)); });
  try_to([&] { check_bridge(load_bridge_config(path, {.server = "[::1]:7000"})); });
  try_to([&] { check_bridge(load_bridge_config(path, {.device = "virtual", .script = "a.csv"})); });
}

}  // namespace irdm::fuzz
