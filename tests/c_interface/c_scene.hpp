#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "c_interface/irdm.h"
#include "precompute/precompute.hpp"
#include "tests/support/temporary_folder.hpp"

namespace irdm::test {

/// A soft cube of 12 cm that falls on a plane of scenery, and a rigid block that falls on the cube;
/// two fingertips.
class CScene {
 public:
  /// @param cells of each body along an edge
  explicit CScene(int cells = 3) : cells_(cells) {
    make("cube", false, 0.12);
    make("block", true, 0.06);
    const std::string folder = folder_.path().string();
    text_ =
        "world.gravity = [0, -9.81, 0]\n"
        "[[stylus]]\nradius = 0.02\ncoupling_stiffness = 500\nreach = 0.01\n"
        "[[stylus]]\nradius = 0.02\ncoupling_stiffness = 500\n"
        "[[object]]\nname = \"cube\"\nmodel = \"" +
        folder +
        "/cube.h5\"\nposition = [0, 0.061, 0]\n"
        "[[object]]\nname = \"block\"\nmodel = \"" +
        folder +
        "/block.h5\"\nposition = [0.01, 0.153, 0]\n"
        "[[scenery]]\nname = \"table\"\nplane = {}\n";
  }

  const std::string& text() const { return text_; }

  /// Fingers that press the cube from two sides and rub it.
  static std::array<irdm_command, 2> commands(int k) {
    std::array<irdm_command, 2> commands{};
    const double depth = 0.004 * std::min(1.0, k / 150.0);
    for (std::size_t s = 0; s < 2; ++s) {
      const double side = s == 0 ? 1.0 : -1.0;
      commands[s].present = k >= 20;
      commands[s].buttons = s == 0 && k >= 120 ? IRDM_GRAB : 0u;
      commands[s].tip[0] = side * (0.062 - depth);
      commands[s].tip[1] = 0.06;
      commands[s].tip[2] = 0.01 * std::sin(0.02 * k);
    }
    return commands;
  }

 private:
  void make(const std::string& name, bool rigid, double size) {
    precompute::PrecomputeConfig config;
    config.name = name;
    config.mesh.source = precompute::BoxConfig{Vector3::Constant(size), {cells_, cells_, cells_}};
    config.mesh.order = 1;
    config.rigid = rigid;
    config.material = {5000.0, 0.4, 110.0, 8.0, 2e-4};
    config.response.dt = 0.002;
    config.response.steps = rigid ? 1 : 100;
    std::ostringstream ignored;
    precompute::precompute_model(config, folder_.path() / (name + ".h5"), {ignored, false});
  }

  int cells_;
  TemporaryFolder folder_;
  std::string text_;
};

/// Closes itself.
class OpenSimulation {
 public:
  explicit OpenSimulation(const std::string& text) {
    std::array<char, 256> message{};
    status = irdm_simulation_parse(text.c_str(), &handle, message.data(), message.size());
    error = message.data();
  }
  OpenSimulation(const OpenSimulation&) = delete;
  OpenSimulation& operator=(const OpenSimulation&) = delete;
  ~OpenSimulation() { irdm_simulation_close(handle); }

  irdm_simulation* handle = nullptr;
  irdm_status status = IRDM_FAILED;
  std::string error;
};

inline std::vector<irdm_contact> contacts_of(const irdm_simulation* simulation) {
  std::size_t count = 0;
  irdm_simulation_contacts(simulation, nullptr, 0, &count);
  std::vector<irdm_contact> contacts(count);
  irdm_simulation_contacts(simulation, contacts.data(), count, &count);
  return contacts;
}

inline std::vector<char> state_of(const irdm_simulation* simulation) {
  std::size_t count = 0;
  irdm_simulation_save(simulation, nullptr, 0, &count);
  std::vector<char> state(count);
  irdm_simulation_save(simulation, state.data(), count, &count);
  return state;
}

}  // namespace irdm::test
