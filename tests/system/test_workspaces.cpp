// Devices with workspaces of their own, as processes: what each of them does in D is done in W.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/support/catch.hpp"
#include "tests/system/stage.hpp"
#include "tests/system/trace.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kHalfEdge = 0.06;

// Comes from 5 mm off to `depth` inside the face x = 6 cm of the cube, along -x, and stays.
std::string press_from_the_right(double scale = 1.0) {
  std::ostringstream script;
  script << "time,x,y,z,button\n";
  for (int k = 0; k <= 100; ++k) {
    const double time = 0.01 * k;
    const double x = kHalfEdge + 0.005 - 0.01 * std::min(1.0, time / 0.5);
    script << time << ',' << x / scale << ",0,0,0\n";
  }
  return script.str();
}

// Half a turn about y: D's x is W's -x, so that the same script presses from the left.
const std::string kFromTheLeft = "workspace = { rotation = [0, 0, 1, 0] }\n";
// The same place in W from a device that is moved half as far, and feels three times the force.
const std::string kHalfSize =
    "workspace = { rotation = [0, 0, 1, 0], scale = 2, force_scale = 3 }\n";

std::string device(const std::string& script, const std::string& more = "") {
  return "[[device]]\nscript = \"" + script + "\"\n" + more;
}

ChildProcess start_bridge(const Stage& stage, const Server& server, const std::string& config) {
  return ChildProcess({IRDM_BRIDGE, stage.path(config).string(), "--server",
                       "127.0.0.1:" + std::to_string(server.port)});
}

Server start_two(const Stage& stage) {
  std::string scene = scene_text();
  scene.replace(scene.find("port = 0"), 8, "port = 0\nstyluses = 2");
  stage.write("scene.toml", scene);
  stage.write("right.csv", press_from_the_right());
  stage.write("half.csv", press_from_the_right(2.0));
  return stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
}

std::string set(int stylus, const char* name) {
  return "/stylus/" + std::to_string(stylus) + "/" + name;
}

// The cube is squeezed between both styluses, wherever each of them is.
void check_squeezed(const Trace& trace) {
  REQUIRE(trace.rows() == 500);
  // Which bridge came first is left to chance.
  const int right = trace.vector(set(0, "tip"), 0).x() > 0 ? 0 : 1;
  const int left = 1 - right;
  double peak = 0.0;
  for (std::size_t k = 0; k < trace.rows(); ++k) {
    const Vector3 tip = trace.vector(set(right, "tip"), k);
    const Vector3 mirrored = trace.vector(set(left, "tip"), k);
    REQUIRE((mirrored + Vector3(tip.x(), 0, 0)).norm() < 1e-12);
    const Vector3 force = trace.vector(set(right, "force"), k);
    const Vector3 opposite = trace.vector(set(left, "force"), k);
    peak = std::max(peak, force.x());
    // The mesh is not symmetric, so neither are the forces, to the last.
    if (k > 400) CHECK((force + opposite).norm() < 0.1 * force.norm());
  }
  CHECK(peak > 0.1);
  CHECK(trace.vector("/step/body_position", 499).norm() < 1e-3);
}

}  // namespace

TEST_CASE("two bridges, each with a workspace of its own, squeeze one object") {
  const Stage stage;
  Server server = start_two(stage);
  stage.write("right.toml", device("right.csv"));
  stage.write("left.toml", device("half.csv", kHalfSize));
  ChildProcess right = start_bridge(stage, server, "right.toml");
  ChildProcess left = start_bridge(stage, server, "left.toml");
  REQUIRE(right.wait() == 0);
  REQUIRE(left.wait() == 0);
  REQUIRE(server.process.wait() == 0);
  const Trace trace = read_trace(stage.path("trace.h5"), 2);
  check_squeezed(trace);
  // The force at the device is that in W times force_scale.
  const int of_right = trace.vector(set(0, "tip"), 0).x() > 0 ? 0 : 1;
  double peak = 0.0;
  for (std::size_t k = 0; k + 1 < trace.rows(); ++k) {
    peak = std::max(peak, trace.vector(set(1 - of_right, "force"), k).norm());
  }
  CHECK(number_after(left.out(), "peak force: ") == Approx(std::min(3.3, 3.0 * peak)).margin(6e-4));
}

TEST_CASE("two styluses of one bridge, each with a workspace of its own, squeeze one object") {
  const Stage stage;
  Server server = start_two(stage);
  stage.write("bridge.toml", device("right.csv") + device("right.csv", kFromTheLeft));
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(bridge.wait() == 0);
  REQUIRE(server.process.wait() == 0);
  check_squeezed(read_trace(stage.path("trace.h5"), 2));
  CHECK_THAT(bridge.out(), ContainsSubstring("styluses 2"));
}

TEST_CASE("a clutched stylus that holds the object stays in W while its device goes elsewhere") {
  const Stage stage;
  // Takes hold of the top, clutches (bit 1), goes back 5 cm, and lifts by 2 cm from there.
  stage.write("script.csv",
              "time,x,y,z,button\n0,0,0.07,0,0\n0.2,0,0.058,0,1\n0.4,0,0.058,0,3\n"
              "0.6,0.05,0.058,0,3\n0.8,0.05,0.058,0,1\n1,0.05,0.058,0,1\n1.5,0.05,0.078,0,1\n"
              "2,0.05,0.078,0,1\n");
  Server server = stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
  stage.write("bridge.toml", device("script.csv"));
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(bridge.wait() == 0);
  REQUIRE(server.process.wait() == 0);
  const Trace trace = read_trace(stage.path("trace.h5"));
  REQUIRE(trace.rows() == 1000);
  for (std::size_t k = 1; k < trace.rows(); ++k) {
    const Vector3 tip = trace.vector(set(0, "tip"), k);
    REQUIRE((tip - trace.vector(set(0, "tip"), k - 1)).norm() < 3e-4);  // never jumps
    REQUIRE(std::abs(tip.x()) < 1e-12);  // the way of 5 cm was made in D alone
    if (k > 200) REQUIRE(trace.buttons[k] == 1);
    if (k > 101) REQUIRE(trace.contact[k] == 2);
  }
  CHECK(trace.vector(set(0, "tip"), 999).y() == Approx(0.078));
}
