#include "tests/system/stage.hpp"

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace irdm::test {
namespace {

constexpr double kPi = std::numbers::pi;

std::string row(double time, double x, double y, double z, int button) {
  std::ostringstream text;
  text << time << ',' << x << ',' << y << ',' << z << ',' << button << '\n';
  return text.str();
}

std::vector<std::string> joined(std::vector<std::string> words,
                                const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

std::filesystem::path cube_model() {
  const std::filesystem::path model = IRDM_SYSTEM_MODEL;
  if (!std::filesystem::exists(model)) {
    const FinishedProgram made = run_to_end(
        {IRDM_PRECOMPUTE, IRDM_SOURCE_DIR "/tests/system/cube.toml", "-o", model.string()});
    if (made.status != 0) throw std::runtime_error("no model: " + made.err);
  }
  return model;
}

std::filesystem::path record(const Stage& stage, bool lockstep) {
  std::vector<std::string> arguments{"--no-viewer", "--record", stage.path("trace.h5").string()};
  if (lockstep) arguments.push_back("--lockstep");
  Server server = stage.start_server(arguments);
  ChildProcess bridge = stage.start_bridge(server);
  const bool played = bridge.wait() == 0;
  if (!lockstep) server.process.signal(SIGTERM);
  const bool served = server.process.wait() == 0;
  if (!played) throw std::runtime_error("the bridge failed: " + bridge.err());
  if (!served) throw std::runtime_error("the server failed: " + server.process.err());
  return stage.path("trace.h5");
}

std::string scene_text(const std::string& more, const std::string& engine) {
  return "[server]\nport = 0\ndeformation_threads = 1\n[contact]\ncoupling_stiffness = 2000\n" +
         more + "[[object]]\nname = \"cube\"\nmodel = \"" + cube_model().string() +
         "\"\nengine = \"" + engine + "\"\n";
}

std::string press_and_swing() {
  std::string script = "time,x,y,z,button\n" + row(0.0, 0.01, 0.0605, 0.02, 0);
  // Faster and faster downwards, so that the floating cube stays under the tip.
  for (int k = 0; k <= 25; ++k) {
    const double time = 0.02 * k;
    script += row(0.1 + time, 0.01, 0.0605 - 0.4 * time * time, 0.02, time < 0.3 ? 0 : 1);
  }
  for (int k = 1; k <= 60; ++k) {
    const double phase = 2.0 * kPi * 1.5 * 0.02 * k;
    script += row(0.6 + 0.02 * k, 0.01 + 0.03 * std::sin(phase), -0.04,
                  0.02 - 0.02 * std::sin(0.7 * phase), 1);
  }
  return script + row(1.82, 0.01, -0.03, 0.02, 0) + row(2.1, 0.01, 0.1, 0.02, 0);
}

std::string hold_and_circle(int minutes) {
  std::string script = "time,x,y,z,button\n";
  script += row(0.0, 0.0, 0.07, 0.0, 0) + row(0.05, 0.0, 0.07, 0.0, 0);
  script += row(0.25, 0.0, kCircleHeight, 0.0, 1);
  for (int k = 1; k <= 6000 * minutes; ++k) {
    const double time = 0.01 * k;
    const double phase = 2.0 * kPi * kCircleRate * time;
    script += row(0.25 + time, kCircleRadius * (1.0 - std::cos(phase)), kCircleHeight,
                  kCircleRadius * std::sin(phase), 1);
  }
  return script;
}

double number_after(const std::string& output, const std::string& name) {
  const std::size_t at = output.find(name);
  if (at == std::string::npos) throw std::runtime_error("no '" + name + "' in:\n" + output);
  return std::strtod(output.c_str() + at + name.size(), nullptr);
}

Stage::Stage() {
  write("scene.toml", scene_text());
  write("script.csv", press_and_swing());
  write("bridge.toml",
        "[[device]]\ntype = \"virtual\"\nscript = \"script.csv\"\n"
        "hand = { mass = 0.12, damping = 2.0, stiffness = 300.0 }\n");
}

void Stage::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
}

void Stage::hold_forces() const {
  std::ofstream(path("bridge.toml"), std::ios::app) << "[bridge]\nmode = \"hold\"\n";
}

Server Stage::start_server(std::vector<std::string> arguments, const ChildOptions& options) const {
  ChildProcess process(joined({IRDM_SERVER, path("scene.toml").string()}, arguments), options);
  const std::string line = process.line_with("listening on ");
  const std::string expected = "listening on 127.0.0.1:";
  if (!line.starts_with(expected)) throw std::runtime_error("it says '" + line + "'");
  const auto port = static_cast<std::uint16_t>(std::stoi(line.substr(expected.size())));
  return {std::move(process), port};
}

Server Stage::restart_server(std::uint16_t port, std::vector<std::string> arguments) const {
  return start_server(joined({"--port", std::to_string(port)}, arguments));
}

ChildProcess Stage::start_bridge(const Server& server, std::vector<std::string> arguments,
                                 const ChildOptions& options) const {
  return ChildProcess(joined({IRDM_BRIDGE, path("bridge.toml").string(), "--server",
                              "127.0.0.1:" + std::to_string(server.port)},
                             arguments),
                      options);
}

}  // namespace irdm::test
