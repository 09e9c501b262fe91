#include <algorithm>
#include <functional>
#include <limits>
#include <stdexcept>

#include "common/hdf5/file.hpp"
#include "common/model/model_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/raw_peer.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::StartsWith;
using namespace irdm;
using namespace irdm::test;

namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("no '" + from + "' to replace");
  return text.replace(at, from.size(), to);
}

// That a program ended with status 1 after one line on stderr, and nothing else.
void check_refusal(const FinishedProgram& program, const std::string& name,
                   const std::string& message) {
  CHECK(program.status == 1);
  CHECK(program.out.empty());
  CHECK(std::count(program.err.begin(), program.err.end(), '\n') == 1);
  CHECK_THAT(program.err, StartsWith(name + ": error: ") && ContainsSubstring(message));
}

void check_server_refuses(const Stage& stage, const std::string& message) {
  CAPTURE(message);
  const FinishedProgram server =
      run_to_end({IRDM_SERVER, stage.path("scene.toml").string(), "--record",
                  stage.path("trace.h5").string(), "--duration", "0.1"});
  check_refusal(server, "irdm-server", message);
  CHECK_FALSE(std::filesystem::exists(stage.path("trace.h5")));
}

// Nobody listens where it is told to connect: it must not get that far.
void check_bridge_refuses(const Stage& stage, const std::string& message) {
  CAPTURE(message);
  const FinishedProgram bridge = run_to_end({IRDM_BRIDGE, stage.path("bridge.toml").string(),
                                             "--server", "127.0.0.1:1", "--duration", "0.1"});
  check_refusal(bridge, "irdm-bridge", message);
}

// A copy of the test's model with something changed before it is written.
void write_model(const std::filesystem::path& path, const std::function<void(Model&)>& change) {
  Model model = read_model(cube_model(), ResponseKind::kModal);
  change(model);
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.write_modal(std::get<ModalResponse>(model.response));
  writer.commit();
}

/// Without the response to spin, which a floating body alone has.
void fix_body(Model& model) {
  model.body.support = Support::kFixed;
  std::get<ModalResponse>(model.response).centrifugal.resize(0, 0);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("bad scene: one line, status 1, no trace") {
  const Stage stage;
  const std::string good = scene_text("[world]\ngravity = [0, 0, 0]\n");
  const auto refused = [&](const std::string& text, const std::string& message) {
    stage.write("scene.toml", text);
    check_server_refuses(stage, message);
  };
  refused("", "scene.toml:1: object is missing; add [[object]] with a model");
  refused(good.substr(0, good.find("engine") + 10), "scene.toml:");
  refused(replaced(good, "port = 0", "port = \"any\""), "scene.toml:2: server.port is not a whole");
  refused(replaced(good, "port = 0", "ports = 0"), "scene.toml:2: server.ports is not a known key");
  refused(replaced(good, "[0, 0, 0]", "[0, nan, 0]"), "world.gravity is nan");
  refused(replaced(good, "[0, 0, 0]", "[0, inf, 0]"), "world.gravity is inf");
  refused(replaced(good, "2000", "-1"), "contact.coupling_stiffness is -1");
  std::filesystem::remove(stage.path("scene.toml"));
  check_server_refuses(stage, "scene.toml: no such file");
  std::filesystem::create_directory(stage.path("scene.toml"));
  check_server_refuses(stage, "scene.toml: is a folder; give the path of a file");
}

TEST_CASE("bad model file: one line, status 1, no trace") {
  const Stage stage;
  const std::string engine = GENERATE("modal", "dense");
  stage.write("scene.toml", replaced(scene_text("", engine), cube_model().string(), "cube.h5"));
  check_server_refuses(stage, "cube.h5: no such file");
  stage.write("cube.h5", "");
  check_server_refuses(stage, "cube.h5: is not a complete HDF5 file");
  stage.write("cube.h5", "not HDF5 at all, but text");
  check_server_refuses(stage, "cube.h5: is not a complete HDF5 file");
  const std::string whole = file_content(cube_model());
  for (const double share : {0.1, 0.5, 0.999}) {
    stage.write(
        "cube.h5",
        whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    check_server_refuses(stage, "cube.h5: ");
  }
  std::filesystem::remove(stage.path("cube.h5"));
  std::filesystem::create_directory(stage.path("cube.h5"));
  check_server_refuses(stage, "cube.h5: ");
}

TEST_CASE("model file with wrong content: one line, status 1, no trace") {
  const Stage stage;
  stage.write("scene.toml", replaced(scene_text(), cube_model().string(), "cube.h5"));
  const auto refused = [&](const std::function<void(Model&)>& change, const std::string& message) {
    write_model(stage.path("cube.h5"), change);
    check_server_refuses(stage, message);
  };
  refused([](Model& model) { model.mesh.nodes(3, 1) = kNan; }, "/mesh/nodes has numbers that are");
  refused([](Model& model) { model.mesh.triangles(0, 0) = 1'000'000; }, "/mesh/triangles points");
  refused([](Model& model) { model.body.mass = -1; }, "/body mass is -1, not a finite number");
  refused([](Model& model) { model.body.inertia.setZero(); }, "/body inertia must be");
  refused([](Model& model) { model.dt = 0; }, "/response dt is 0, not a finite number");
  refused([](Model& model) { model.dt = kNan; }, "/response dt is nan, not a finite number");
  refused([](Model& model) { std::get<ModalResponse>(model.response).decay_rate(0) = kNan; },
          "/response/modal/decay_rate has a number");
  refused(
      [](Model& model) {
        auto& response = std::get<ModalResponse>(model.response);
        std::visit(
            [](auto& shapes) {
              shapes.data()[0] =
                  std::numeric_limits<std::decay_t<decltype(shapes.data()[0])>>::infinity();
            },
            response.shapes);
      },
      "/response/modal/shapes has numbers that are not finite");
  write_model(stage.path("cube.h5"), [](Model&) {});
  stage.write("scene.toml", replaced(file_content(stage.path("scene.toml")), "modal", "dense"));
  check_server_refuses(stage, "has no dense response");
  std::filesystem::remove(stage.path("cube.h5"));
  hdf5::File::create(stage.path("cube.h5")).write_attribute("/", "format", std::string("other"));
  check_server_refuses(stage, "is not a model file");
  // A sound model of before there was inertial loading.
  stage.write("scene.toml", replaced(scene_text() + "inertial_loading = true\n",
                                     cube_model().string(), "cube.h5"));
  refused([](Model& model) { std::get<ModalResponse>(model.response).centrifugal.resize(0, 0); },
          "cube.h5: has no centrifugal response for engine = \"modal\", which inertial_loading "
          "needs; precompute it again with method = \"modal\"");
}

TEST_CASE("a fixed object whose model does not say how it sags is played with a warning") {
  const Stage stage;
  const auto warnings = [&](const std::string& gravity, const std::function<void(Model&)>& change) {
    stage.write("scene.toml", replaced(scene_text("[world]\ngravity = " + gravity + "\n"),
                                       cube_model().string(), "cube.h5"));
    write_model(stage.path("cube.h5"), change);
    const FinishedProgram server = run_to_end(
        {IRDM_SERVER, stage.path("scene.toml").string(), "--no-viewer", "--duration", "0.1"});
    CHECK(server.status == 0);
    return server.err;
  };
  CHECK_THAT(
      warnings("[0, -9.81, 0]", fix_body),
      ContainsSubstring("irdm-server: warning: ") &&
          ContainsSubstring("scene.toml: fixed object 'cube' does not sag under gravity: its model "
                            "does not say how; precompute it again with method = \"modal\"\n"));
  CHECK_THAT(warnings("[0, 0, 0]", fix_body), !ContainsSubstring("sag"));
  CHECK_THAT(warnings("[0, -9.81, 0]", [](Model&) {}), !ContainsSubstring("sag"));
  CHECK_THAT(warnings("[0, -9.81, 0]",
                      [](Model& model) {
                        fix_body(model);
                        auto& response = std::get<ModalResponse>(model.response);
                        response.gravity = AxisColumns::Zero(response.mode_count(), 3);
                      }),
             !ContainsSubstring("sag"));
}

TEST_CASE("a model whose steps are too long for a hand is played with a warning") {
  const Stage stage;
  stage.write("scene.toml", replaced(scene_text(), cube_model().string(), "cube.h5"));
  write_model(stage.path("cube.h5"), [](Model& model) { model.dt = 0.05; });
  const FinishedProgram server = run_to_end(
      {IRDM_SERVER, stage.path("scene.toml").string(), "--no-viewer", "--duration", "0.1"});
  CHECK(server.status == 0);
  CHECK_THAT(server.err, ContainsSubstring("the model's dt of 0.05 s is too long for a hand"));
}

TEST_CASE("a fixed object without a coupling spring: one line, status 1, no trace") {
  const Stage stage;
  write_model(stage.path("cube.h5"), fix_body);
  const std::string scene = replaced(scene_text(), cube_model().string(), "cube.h5");
  stage.write("scene.toml", replaced(scene, "coupling_stiffness = 2000", "coupling_stiffness = 0"));
  check_server_refuses(stage,
                       "scene.toml: object 'cube' is fixed and contact.coupling_stiffness is "
                       "0");
  stage.write("scene.toml", replaced(scene, "coupling_stiffness = 2000", "coupling_stiffness = 1"));
  CHECK_NOTHROW(stage.start_server());
}

TEST_CASE("bad script: one line, status 1") {
  const Stage stage;
  const std::string good = "time,x,y,z,button\n0,0,0.08,0,0\n0.1,0,0.07,0,0\n0.2,0,0.06,0,1\n";
  const auto refused = [&](const std::string& text, const std::string& message) {
    stage.write("script.csv", text);
    check_bridge_refuses(stage, message);
  };
  refused("", "script.csv: is empty");
  refused("time,x,y,z\n", "script.csv: has no rows");
  refused(good.substr(0, good.size() - 6), "script.csv:4: has 3 values");
  refused(replaced(good, "0.08", "high"), "script.csv:2: 'high' is not a number");
  refused(replaced(good, "button", "pressure"), "script.csv:1: ");
  refused(replaced(good, "0.07", "nan"), "script.csv:3: 'nan' is not finite");
  refused(replaced(good, "0.07", "inf"), "script.csv:3: 'inf' is not finite");
  refused(replaced(good, "0.07", "1e999"), "script.csv:3: '1e999' is not finite");
  refused(replaced(good, "0.2,", "0.1,"), "script.csv:4: time 0.1 does not come after");
  refused(replaced(good, "0.2,", "0.05,"), "script.csv:4: time 0.05 does not come after");
  std::filesystem::remove(stage.path("script.csv"));
  check_bridge_refuses(stage, "script.csv: no such stylus script");
}

TEST_CASE("bad bridge configuration: one line, status 1") {
  const Stage stage;
  const std::string good = file_content(stage.path("bridge.toml"));
  const auto refused = [&](const std::string& text, const std::string& message) {
    stage.write("bridge.toml", text);
    check_bridge_refuses(stage, message);
  };
  refused("", "bridge.toml: has no device");
  refused(good.substr(0, good.find("script.csv")), "bridge.toml:");
  refused(replaced(good, "0.12", "\"heavy\""), "mass is not a number");
  refused(replaced(good, "script =", "skript ="), "has no script");
  refused(good + "colour = \"red\"\n", "colour is not a known key");
  refused(replaced(good, "300.0", "nan"), "stiffness is nan");
  refused(replaced(good, "0.12", "inf"), "mass is inf");
  refused(replaced(good, "\"virtual\"", "\"magic\""), "type is 'magic'");
  std::filesystem::remove(stage.path("bridge.toml"));
  check_bridge_refuses(stage, "bridge.toml: no such file");
}

TEST_CASE("a trace that cannot be made is told, and nothing of it is left") {
  const Stage stage;
  const auto record = [&](const std::string& trace) {
    return run_to_end({IRDM_SERVER, stage.path("scene.toml").string(), "--record",
                       stage.path(trace).string(), "--duration", "0.1"});
  };
  SECTION("no such folder") {
    check_refusal(record("nowhere/trace.h5"), "irdm-server",
                  "nowhere/trace.h5: cannot be created: No such file or directory; check that the "
                  "folder exists");
    CHECK_FALSE(std::filesystem::exists(stage.path("nowhere")));
  }
  SECTION("a port that is taken") {
    const RawListener taken;
    stage.write("scene.toml",
                replaced(scene_text(), "port = 0", "port = " + std::to_string(taken.port())));
    check_refusal(record("trace.h5"), "irdm-server", "cannot listen: Address already in use");
    CHECK_FALSE(std::filesystem::exists(stage.path("trace.h5")));
  }
}

TEST_CASE("wrong usage of server and bridge ends with status 2, help and version with 0") {
  const Stage stage;
  const std::string scene = stage.path("scene.toml").string();
  const std::string bridge = stage.path("bridge.toml").string();
  using Words = std::vector<std::string>;
  for (const Words& words :
       {Words{IRDM_SERVER}, Words{IRDM_SERVER, scene, "--frobnicate"},
        Words{IRDM_SERVER, scene, "--port", "65536"}, Words{IRDM_SERVER, scene, "--port", "ssh"},
        Words{IRDM_SERVER, scene, "--duration", "0"}, Words{IRDM_SERVER, scene, "--duration", "-1"},
        Words{IRDM_SERVER, scene, "--duration", "nan"}, Words{IRDM_SERVER, scene, "--record"},
        Words{IRDM_SERVER, scene, scene}, Words{IRDM_BRIDGE},
        Words{IRDM_BRIDGE, bridge, "--device", "magic"},
        Words{IRDM_BRIDGE, bridge, "--duration", "0"},
        Words{IRDM_BRIDGE, bridge, "--duration", "nan"}, Words{IRDM_BRIDGE, bridge, "--server"}}) {
    CAPTURE(words);
    const FinishedProgram program = run_to_end(words);
    CHECK(program.status == 2);
    CHECK_FALSE(program.err.empty());
  }
  for (const char* name : {IRDM_SERVER, IRDM_BRIDGE}) {
    const FinishedProgram help = run_to_end({name, "--help"});
    CHECK(help.status == 0);
    CHECK_THAT(help.out, ContainsSubstring("--duration"));
    CHECK(help.err.empty());
    const FinishedProgram version = run_to_end({name, "--version"});
    CHECK(version.status == 0);
    CHECK_THAT(version.out, StartsWith(std::filesystem::path(name).filename().string() + " "));
  }
}

TEST_CASE("a server that is not named, or not a server's name, is told in one line") {
  const Stage stage;
  const std::string config = stage.path("bridge.toml").string();
  check_refusal(run_to_end({IRDM_BRIDGE, config}), "irdm-bridge", "no server is named");
  check_refusal(run_to_end({IRDM_BRIDGE, config, "--server", "localhost"}), "irdm-bridge",
                "--server: 'localhost' has no port");
  check_refusal(run_to_end({IRDM_BRIDGE, config, "--server", "localhost:0"}), "irdm-bridge",
                "'localhost:0' is not a server");
}

TEST_CASE("where no server listens the bridge says so once, and ends after its duration") {
  const Stage stage;
  const FinishedProgram bridge = run_to_end({IRDM_BRIDGE, stage.path("bridge.toml").string(),
                                             "--server", "127.0.0.1:1", "--duration", "1"});
  CHECK(bridge.status == 1);
  CHECK(std::count(bridge.err.begin(), bridge.err.end(), '\n') == 2);
  CHECK_THAT(bridge.err,
             ContainsSubstring("server 127.0.0.1:1: no connection: Connection refused; trying") &&
                 ContainsSubstring("irdm-bridge: error: 127.0.0.1:1: no session in 1 s: ") &&
                 ContainsSubstring("start irdm-server there"));
}
