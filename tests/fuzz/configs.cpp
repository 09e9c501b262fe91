// The TOML files of the three programs. What is wrong with a file is told by irdm::Error in one
// line.
#include <algorithm>
#include <cmath>
#include <string>

#include "common/error.hpp"
#include "device_bridge/bridge_config.hpp"
#include "precompute/config.hpp"
#include "server/config/scene.hpp"
#include "tests/fuzz/harness.hpp"

namespace irdm::fuzz {
namespace {

constexpr double kRounding = 1e-9;

void expect_unit(double norm, const char* what) {
  expect(std::abs(norm - 1.0) < kRounding, what);
}

template <typename Read>
void read_toml(Input input, const Read& read) {
  try {
    read(TomlTable::parse_text(std::string(text_of(input)), "it.toml"));
  } catch (const Error& error) {
    const std::string_view line = error.what();
    expect(std::none_of(line.begin(), line.end(),
                        [](unsigned char c) { return c < 0x20 || c == 0x7F; }),
           "an error is one line without control characters");
  }
}

}  // namespace

void scene_config(Input input) {
  read_toml(input, [](TomlTable file) {
    const SceneConfig scene = read_scene(std::move(file));
    if (scene.floor) expect_unit(scene.floor->normal.norm(), "the floor's normal has length 1");
    for (const ObjectConfig& object : scene.objects) {
      expect_unit(object.orientation.norm(), "an orientation has norm 1");
      expect(object.friction.kinetic <= object.friction.static_, "kinetic <= static");
      expect(object.position.allFinite() && object.velocity.allFinite(), "motion is finite");
    }
    expect(!scene.styluses.empty() && scene.styluses.size() <= kMaxStyluses, "1 to 4 styluses");
  });
}

void precompute_config(Input input) {
  read_toml(input, [](TomlTable file) {
    using namespace precompute;
    const PrecomputeConfig config = read_config(std::move(file), "it.toml");
    const int intervals = std::min(config.response.steps, 20);
    for (const int count : step_schedule(config.time_stepping, config.response.dt, intervals)) {
      expect(count >= 1, "every interval has a step");
    }
    if (const auto* box = std::get_if<BoxConfig>(&config.mesh.source)) {
      expect((box->size.array() > 0.0).all(), "a box has a size");
    }
  });
}

void bridge_config(Input input) {
  read_toml(input, [](TomlTable file) {
    const BridgeConfig config = read_bridge_config(std::move(file), "it.toml");
    expect(!config.server || (!config.server->host.empty() && config.server->port > 0),
           "a server has host and port");
    for (const DeviceConfig& device : config.devices) {
      expect_unit(device.mapping.workspace.rotation.norm(), "a rotation has norm 1");
    }
  });
}

}  // namespace irdm::fuzz
