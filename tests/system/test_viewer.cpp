// The viewer of a real irdm-server.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "common/hdf5/file.hpp"
#include "common/model/model_file.hpp"
#include "common/model/model_writer.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/system/stage.hpp"
#include "tests/system/trace.hpp"
#include "tests/viewer/web_peer.hpp"
#include "viewer/message.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

const std::string kUrl = "listening on http://127.0.0.1:";

std::uint16_t viewer_port(ChildProcess& server) {
  return static_cast<std::uint16_t>(std::stoi(server.line_with(kUrl).substr(kUrl.size())));
}

WebPeer watch(std::uint16_t port, int receive_buffer = 0) {
  WebPeer peer(port, receive_buffer);
  peer.open();
  peer.send_message(encode(viewer::ClientMessage(viewer::Hello{})));
  return peer;
}

/// The next message of a type, whatever else comes before it.
WebPeer::Message next(WebPeer& peer, int type) {
  for (;;) {
    auto message = peer.receive();
    REQUIRE(message);
    REQUIRE(message->opcode == 2);
    if (message->payload.at(6) == type) return *message;
  }
}
constexpr int kScene = 1;
constexpr int kFrame = 2;
constexpr int kHealth = 3;
constexpr int kState = 4;

std::size_t nodes_of(const WebPeer::Message& scene) {
  return static_cast<std::size_t>(viewer::decode_scene(scene.payload).objects.at(0).rest.rows());
}

/// The cube with another material where x > 0, B; its response is that of one material.
void write_half_stiff_cube(const std::filesystem::path& path) {
  Model model = read_model(cube_model(), ResponseKind::kModal);
  const Material& whole = model.material;
  ElementMaterials elements;
  for (Eigen::Index e = 0; e < model.mesh.tets.rows(); ++e) {
    double x = 0.0;
    for (Eigen::Index c = 0; c < 4; ++c) x += model.mesh.nodes(model.mesh.tets(e, c), 0);
    elements.region.push_back(x > 0.0 ? 1 : 0);
    elements.youngs_modulus.push_back(whole.youngs_modulus * (x > 0.0 ? 8.0 : 1.0));
    elements.poisson_ratio.push_back(whole.poisson_ratio);
    elements.density.push_back(whole.density);
  }
  model.material.elements = elements;
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.write_modal(std::get<ModalResponse>(model.response));
  writer.commit();
}

}  // namespace

TEST_CASE("viewer: a body of several materials comes with its regions, another without") {
  const Stage stage;
  write_half_stiff_cube(stage.path("half.h5"));
  stage.write("scene.toml", scene_text("[[object]]\nname = \"half\"\nmodel = \"half.h5\"\n"
                                       "position = [0, 0.3, 0]\n"));
  Server server = stage.start_server();
  WebPeer peer = watch(viewer_port(server.process));
  const viewer::Scene scene = viewer::decode_scene(next(peer, kScene).payload);
  CHECK(scene.objects.at(1).regions.empty());
  const viewer::SceneRegions& regions = scene.objects.at(0).regions;
  REQUIRE(regions.regions.size() == 2);
  const float soft = scene.objects[0].stiffness;
  CHECK(regions.regions[1].youngs_modulus.lowest == 8.0F * soft);
  CHECK(regions.faces.rows() > 4);
  CHECK(regions.face_modulus.front() == 8.0F * soft);
  const auto at_surface = [&](float modulus) {
    return std::ranges::count(regions.surface_modulus, modulus);
  };
  CHECK(at_surface(soft) > 10);
  CHECK(at_surface(8.0F * soft) > 10);
  CHECK(at_surface(soft) + at_surface(8.0F * soft) == scene.objects[0].triangles.rows());
}

TEST_CASE("viewer: a reset over the WebSocket shows up in the trace and in health") {
  const Stage stage;
  stage.write("scene.toml", scene_text("[world]\ngravity = [0, -1, 0]\n"));
  Server server = stage.start_server({"--record", stage.path("trace.h5").string()});
  WebPeer peer = watch(viewer_port(server.process));
  const std::size_t nodes = nodes_of(next(peer, kScene));
  const auto height = [&] {
    const auto frame = viewer::decode_frame(next(peer, kFrame).payload, {&nodes, 1});
    return frame.objects.at(0).position.y();
  };
  REQUIRE(eventually([&] { return height() < -0.1; }));  // it falls
  peer.send_message(encode(viewer::ClientMessage(viewer::Command{})));
  CHECK(eventually([&] { return height() > -0.05; }));
  CHECK(eventually([&] { return viewer::decode_health(next(peer, kHealth).payload).resets == 1; }));
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  const Trace trace = read_trace(stage.path("trace.h5"));
  CHECK(std::count(trace.reset.begin(), trace.reset.end(), 1) == 1);
  while (const auto message = peer.receive()) {
    if (message->opcode == 8) CHECK(message->close_code() == 1001);
  }
}

TEST_CASE("viewer: in lockstep, viewers change no bit of the run, and see its last step") {
  const auto play = [](bool watched) {
    const Stage stage;
    Server server = stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
    const std::uint16_t port = viewer_port(server.process);
    std::vector<WebPeer> viewers;
    if (watched) {
      viewers.push_back(watch(port));
      viewers.push_back(watch(port, 4096));  // never reads
    }
    ChildProcess bridge = stage.start_bridge(server);
    REQUIRE(bridge.wait() == 0);
    REQUIRE(server.process.wait() == 0);
    const Trace trace = read_trace(stage.path("trace.h5"));
    if (watched) {
      const std::size_t nodes = nodes_of(next(viewers[0], kScene));
      std::uint64_t newest = 0;
      while (const auto message = viewers[0].receive()) {
        if (message->opcode != 2 || message->payload.at(6) != kFrame) continue;
        const auto frame = viewer::decode_frame(message->payload, {&nodes, 1});
        newest = frame.force_step;
        REQUIRE(newest < trace.rows());
        if (!frame.styluses.at(0).present) continue;
        CHECK(frame.styluses.at(0).tip == trace.vector("/stylus/0/tip", newest));
      }
      CHECK(newest == trace.rows() - 1);
    }
    return trace;
  };
  const Trace alone = play(false);
  const Trace watched = play(true);
  REQUIRE(alone.rows() == watched.rows());
  for (const auto& [name, values] : alone.numbers) {
    CAPTURE(name);
    CHECK(std::memcmp(values.data(), watched.numbers.at(name).data(),
                      values.size() * sizeof(double)) == 0);
  }
}

TEST_CASE("viewer: it can be left out, by the scene and by --no-viewer") {
  const Stage stage;
  const bool by_option = GENERATE(true, false);
  if (!by_option) stage.write("scene.toml", "[viewer]\nenabled = false\n" + scene_text());
  Server server = stage.start_server(by_option ? std::vector<std::string>{"--no-viewer"}
                                               : std::vector<std::string>{});
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  CHECK_THAT(server.process.out(), !ContainsSubstring("http"));
}

TEST_CASE("viewer: an address that can be reached from elsewhere needs a token") {
  const Stage stage;
  stage.write("scene.toml", "[viewer]\naddress = \"0.0.0.0\"\n" + scene_text());
  const FinishedProgram ended = run_to_end({IRDM_SERVER, stage.path("scene.toml").string()});
  CHECK(ended.status == 1);
  CHECK_THAT(ended.err, ContainsSubstring("set viewer.token"));
}

TEST_CASE("viewer: a token's file opens to those who have the token, on loopback, too") {
  const Stage stage;
  const std::string token = "0123456789abcdef";
  const std::filesystem::path file = stage.path("irdm.token");
  stage.write("irdm.token", token + "\n");
  stage.write("scene.toml", "[viewer]\ntoken_file = \"irdm.token\"\n" + scene_text());
  std::filesystem::permissions(file, std::filesystem::perms(0644));
  const FinishedProgram refused = run_to_end({IRDM_SERVER, stage.path("scene.toml").string()});
  CHECK(refused.status == 1);
  CHECK_THAT(refused.err,
             ContainsSubstring("irdm.token: is a token that others may read or write"));
  std::filesystem::permissions(file, std::filesystem::perms(0600));
  Server server = stage.start_server({"--record", stage.path("trace.h5").string()});
  const std::uint16_t port = viewer_port(server.process);
  WebPeer stranger = watch(port);
  const auto answer = stranger.receive();
  REQUIRE(answer);
  CHECK(answer->close_code() == 1008);
  WebPeer peer(port);
  peer.open();
  peer.send_message(encode(viewer::ClientMessage(viewer::Hello{token, false})));
  next(peer, kScene);
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  CHECK_THAT(file_content(stage.path("trace.h5")), !ContainsSubstring(token));
}

TEST_CASE("viewer: where all addresses are listened on, those that can be opened are printed") {
  const Stage stage;
  stage.write("irdm.token", "0123456789abcdef");
  std::filesystem::permissions(stage.path("irdm.token"), std::filesystem::perms(0600));
  stage.write("scene.toml",
              "[viewer]\naddress = \"0.0.0.0\"\ntoken_file = \"irdm.token\"\n" + scene_text());
  Server server = stage.start_server();
  WebPeer peer(viewer_port(server.process));  // the first of the lines is of 127.0.0.1
  peer.open();
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  CHECK_THAT(server.process.out(), !ContainsSubstring("0.0.0.0"));
}

TEST_CASE("viewer: its stylus, friction and gravity act on the run and are in its trace") {
  const Stage stage;
  Server server = stage.start_server({"--record", stage.path("trace.h5").string()});
  WebPeer peer = watch(viewer_port(server.process));
  const std::size_t nodes = nodes_of(next(peer, kScene));
  const auto state = [&] { return viewer::decode_state(next(peer, kState).payload, 1); };
  const viewer::State first = state();
  CHECK(first.stylus_free);
  CHECK(first.choices.at(0).material_damping);
  viewer::StylusRequest hand{true, 0, Vector3(0.0, 0.07, 0.0)};
  const auto force = [&] {
    hand.tip.y() = std::max(hand.tip.y() - 5e-4, 0.055);
    peer.send_message(encode(viewer::ClientMessage(hand)));
    return viewer::decode_frame(next(peer, kFrame).payload, {&nodes, 1})
        .styluses.at(1)
        .force.norm();
  };
  REQUIRE(eventually([&] { return force() > 0.05; }));
  viewer::SettingsRequest settings{first.settings, 1};
  settings.settings.object[0].friction = {0.25, 0.125};
  settings.settings.gravity = Vector3(0, -1, 0);
  peer.send_message(encode(viewer::ClientMessage(settings)));
  CHECK(eventually([&] { return state().settings == settings.settings; }));
  settings.settings.object[0].tether.stiffness = 1e8;
  peer.send_message(encode(viewer::ClientMessage(settings)));
  CHECK(eventually([&] { return state().notice.find("too stiff") != std::string::npos; }));
  CHECK(eventually([&] {
    return viewer::decode_frame(next(peer, kFrame).payload, {&nodes, 1}).objects[0].position.y() <
           -0.1;
  }));
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  const Trace trace = read_trace(stage.path("trace.h5"), 2);
  double largest = 0.0;
  for (std::size_t k = 0; k < trace.rows(); ++k) {
    largest = std::max(largest, trace.vector("/stylus/1/force", k).norm());
  }
  CHECK(largest > 0.05);
  CHECK(largest < 3.3 * 1.1);
  const hdf5::File file = hdf5::File::open(stage.path("trace.h5"));
  CHECK(file.read<double>("/settings/object/0/friction", {2, 2}) ==
        std::vector<double>{first.settings.object[0].friction.static_,
                            first.settings.object[0].friction.kinetic, 0.25, 0.125});
  CHECK(file.read<double>("/settings/gravity", {2, 3}) == std::vector<double>{0, 0, 0, 0, -1, 0});
}

TEST_CASE("viewer: --play shows a recorded run, at the time that is asked for") {
  const Stage stage;
  {
    Server server = stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
    ChildProcess bridge = stage.start_bridge(server);
    REQUIRE(bridge.wait() == 0);
    REQUIRE(server.process.wait() == 0);
  }
  const Trace trace = read_trace(stage.path("trace.h5"));
  ChildProcess server(
      {IRDM_SERVER, stage.path("scene.toml").string(), "--play", stage.path("trace.h5").string()});
  WebPeer peer = watch(viewer_port(server));
  const auto scene = next(peer, kScene);
  CHECK(viewer::decode_scene(scene.payload).recorded);
  CHECK_FALSE(viewer::decode_scene(scene.payload).viewer_stylus);
  const std::size_t nodes = nodes_of(scene);
  const auto ask = [&](viewer::CommandKind kind, double value = 0.0) {
    peer.send_message(encode(viewer::ClientMessage(viewer::Command{kind, 0, value})));
  };
  ask(viewer::CommandKind::kPausePlayback);
  for (const std::size_t k : {trace.rows() / 2, trace.rows() - 1, trace.rows() / 3}) {
    ask(viewer::CommandKind::kSeek, trace.time[k]);
    REQUIRE(eventually([&] {
      const auto frame = viewer::decode_frame(next(peer, kFrame).payload, {&nodes, 1});
      if (frame.force_step != k) return false;
      CHECK(frame.objects.at(0).position == trace.vector("/step/body_position", k));
      CHECK(frame.styluses.at(0).tip == trace.vector("/stylus/0/tip", k));
      const Vector3 force = trace.vector("/stylus/0/force", k);
      CHECK((frame.styluses.at(0).force - force).norm() <= 1e-6 * (1.0 + force.norm()));
      return true;
    }));
  }
  server.signal(SIGTERM);
  CHECK(server.wait() == 0);
}

TEST_CASE("viewer: what --play cannot show is refused in one line") {
  const Stage stage;
  const auto refusal = [&](const std::string& file) {
    const FinishedProgram ended = run_to_end(
        {IRDM_SERVER, stage.path("scene.toml").string(), "--play", stage.path(file).string()});
    CHECK(ended.status == 1);
    CHECK(ended.out.empty());
    CHECK(std::count(ended.err.begin(), ended.err.end(), '\n') == 1);
    return ended.err;
  };
  CHECK_THAT(refusal("missing.h5"), ContainsSubstring("missing.h5"));
  CHECK_THAT(refusal("scene.toml"), ContainsSubstring("scene.toml"));
  std::filesystem::copy_file(cube_model(), stage.path("model.h5"));
  CHECK_THAT(refusal("model.h5"), ContainsSubstring("is not a trace"));
}

namespace {

/// The stage's scene and another one, in a folder to choose from.
std::string scenes_folder(const Stage& stage) {
  std::filesystem::create_directory(stage.path("scenes"));
  stage.write("scenes/cube.toml", scene_text());
  stage.write("scenes/falling.toml", scene_text("[world]\ngravity = [0, -1, 0]\n"));
  return stage.path("scenes").string();
}

void load(WebPeer& peer, const std::string& name) {
  peer.send_message(encode(viewer::ClientMessage(viewer::SceneRequest{name})));
}

viewer::State next_state(WebPeer& peer) {
  return viewer::decode_state(next(peer, kState).payload, 1);
}

std::size_t count_of(const std::string& text, const std::string& words) {
  std::size_t count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) {
    ++count;
  }
  return count;
}

}  // namespace

TEST_CASE("viewer: scenes follow each other at the same ports, each with its report") {
  const Stage stage;
  Server server = stage.start_server({"--scenes", scenes_folder(stage)});
  const std::uint16_t port = viewer_port(server.process);
  std::string bridges = server.process.line_with("listening on ");
  for (const std::string name : {"falling.toml", "cube.toml", "falling.toml"}) {
    WebPeer peer = watch(port);
    next(peer, kScene);
    load(peer, name);
    while (const auto message = peer.receive()) {
      if (message->opcode != 8) continue;
      CHECK(message->close_code() == 1001);
      break;
    }
    viewer::State state;
    REQUIRE(eventually([&] {
      try {
        WebPeer again = watch(port);
        next(again, kScene);
        state = next_state(again);
        return state.notice == "loaded: " + name;
      } catch (const std::exception&) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));  // it is not there yet
        return false;
      }
    }));
    CHECK(state.scenes.at(state.scene) == name);
    CHECK(state.settings.gravity.y() == (name == "cube.toml" ? 0.0 : -1.0));
  }
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  CHECK(count_of(server.process.out(), "\nsteps: ") == 4);
  CHECK(count_of(server.process.out(), bridges + "\n") == 4);
}

TEST_CASE("viewer: a run that is recorded or in lockstep keeps its scene, and says so") {
  const Stage stage;
  std::vector<std::string> arguments{"--scenes", scenes_folder(stage)};
  if (GENERATE(false, true)) {
    arguments.push_back("--lockstep");
  } else {
    arguments.insert(arguments.end(), {"--record", stage.path("trace.h5").string()});
  }
  Server server = stage.start_server(arguments);
  WebPeer peer = watch(viewer_port(server.process));
  next(peer, kScene);
  const viewer::State state = next_state(peer);
  CHECK(state.has_scenes);
  CHECK_FALSE(state.can_load);
  load(peer, "cube.toml");
  CHECK_THAT(next_state(peer).notice, ContainsSubstring("cube.toml: cannot be loaded"));
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
}

TEST_CASE("viewer: without a folder of scenes there is nothing to load") {
  const Stage stage;
  Server server = stage.start_server();
  WebPeer peer = watch(viewer_port(server.process));
  next(peer, kScene);
  CHECK_FALSE(next_state(peer).has_scenes);
  load(peer, "scene.toml");
  CHECK_THAT(next_state(peer).notice, ContainsSubstring("--scenes"));
}

TEST_CASE("a bridge that is sent to the page's port says so in one line, and ends") {
  const Stage stage;
  Server server = stage.start_server();
  const std::string page = "127.0.0.1:" + std::to_string(viewer_port(server.process));
  const FinishedProgram bridge =
      run_to_end({IRDM_BRIDGE, stage.path("bridge.toml").string(), "--server", page});
  CHECK(bridge.status == 1);
  CHECK(bridge.err == "irdm-bridge: error: " + page +
                          ": is no irdm-server's port for bridges; give the one that it prints "
                          "after 'listening on', not its page's\n");
}
