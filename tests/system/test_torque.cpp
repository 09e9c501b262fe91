// Torque from a tool in the server to the hand that holds it at the bridge.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "common/hdf5/file.hpp"
#include "common/motion/rigid_body.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"
#include "tests/system/device_stage.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kRodLong = 0.12;        // [m]
constexpr double kRodThick = 0.012;      // [m]
constexpr double kRodSlope = -0.4;       // of the rod about z, its far end down [rad]
constexpr double kHeldAt = 0.03;         // where the hand wants its near end [m]
constexpr double kHandStiffness = 300;   // of the hand [N/m]
constexpr double kTurnStiffness = 0.75;  // [N m/rad]

// A hand holds a rigid rod by one end and presses the edge of the other onto a plane.
void lay_rod(const Stage& stage) {
  stage.write("rod.toml",
              "[mesh]\nbox = { size = [0.12, 0.012, 0.012], cells = [6, 1, 1] }\n"
              "[material]\nrigid = true\ndensity = 2000.0\n[response]\ndt = 0.002\n");
  const FinishedProgram made = run_to_end(
      {IRDM_PRECOMPUTE, stage.path("rod.toml").string(), "-o", stage.path("rod.h5").string()});
  REQUIRE(made.status == 0);
  stage.write("scene.toml",
              "[[stylus]]\ntool = { object = \"rod\" }\n[[scenery]]\nplane = {}\n"
              "[[object]]\nname = \"rod\"\nmodel = \"rod.h5\"\nposition = [0.06, 0.106, 0.006]\n");
  const std::string turn = ",0,0.98006657784124,0,0,-0.19866933079506\n";
  stage.write("script.csv", "time,x,y,z,qw,qx,qy,qz\n0,0,0.1" + turn + "0.4,0,0.1" + turn +
                                "1.0,0,0.03" + turn + "3.0,0,0.03" + turn);
  stage.write("bridge.toml", "[[device]]\nscript = \"script.csv\"\nhand = { inertia = 3e-4 }\n");
}

/// The last row of a set of a trace.
std::vector<double> last_row(const hdf5::File& trace, const std::string& set, hsize_t width) {
  const hsize_t rows = trace.shape("/step/time")[0];
  const std::vector<double> all = trace.read<double>(set, {rows, width});
  return {all.end() - static_cast<std::ptrdiff_t>(width), all.end()};
}

Vector3 last_vector(const hdf5::File& trace, const std::string& set) {
  return Vector3(last_row(trace, set, 3).data());
}

Quaternion last_turn(const hdf5::File& trace, const std::string& set) {
  const std::vector<double> wxyz = last_row(trace, set, 4);
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

std::vector<double> lengths(const hdf5::File& file, const std::string& set) {
  const std::vector<double> vectors = file.read<double>(set, {0, 3});
  std::vector<double> found;
  for (std::size_t i = 0; i < vectors.size(); i += 3) {
    found.push_back(Vector3(vectors.data() + i).norm());
  }
  return found;
}

// Of the bridge, where its server is killed so long after it was welcomed; empty: nothing was felt.
std::filesystem::path kill_server(const Stage& stage, int after_ms) {
  constexpr int kSoonMs = 3000;
  Server server = stage.start_server({}, {.folder = stage.path("")});
  ChildProcess bridge = stage.start_bridge(server, {}, {.folder = stage.path("")});
  bridge.line_with("session ", true);
  std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
  server.process.signal(SIGKILL);
  server.process.wait();
  std::filesystem::path found;
  eventually(
      [&] {
        std::error_code ignored;
        for (const auto& entry :
             std::filesystem::directory_iterator(stage.path("blackbox"), ignored)) {
          const std::string name = entry.path().filename().string();
          if (name.starts_with("irdm-bridge-") && name.ends_with(".h5")) found = entry.path();
        }
        return !found.empty();
      },
      kSoonMs);
  return found;
}

}  // namespace

TEST_CASE("torque: a hand that presses with a rod feels its force times the rod's lever") {
  const Stage stage;
  lay_rod(stage);
  Server server = stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(bridge.wait() == 0);
  REQUIRE(server.process.wait() == 0);
  const hdf5::File trace = hdf5::File::open(stage.path("trace.h5"));
  // What the hand feels is told by how it gives way, at rest.
  const Quaternion wanted(Eigen::AngleAxisd(kRodSlope, Vector3::UnitZ()));
  const Vector3 force =
      kHandStiffness * (last_vector(trace, "/stylus/0/tip") - Vector3(0, kHeldAt, 0));
  const Vector3 torque =
      kTurnStiffness *
      rotation_vector(last_turn(trace, "/stylus/0/orientation") * wanted.conjugate());
  // The rod touches the plane with its far lower edge.
  const Quaternion turned = last_turn(trace, "/step/body_orientation");
  const Vector3 lever = turned * Vector3(kRodLong, 0, 0.5 * kRodThick);
  const Vector3 held = last_vector(trace, "/step/body_position") -
                       turned * Vector3(0.5 * kRodLong, 0.5 * kRodThick, 0.5 * kRodThick);
  INFO("force " << force.transpose() << " N, torque " << torque.transpose() << " N m, lever "
                << lever.transpose() << " m; the edge is at " << (held + lever).y() << " m; "
                << bridge.out());
  CHECK(std::abs((held + lever).y()) < 1e-5);
  CHECK(force.y() > 0.1);
  CHECK(torque.z() > 0.01);
  CHECK(torque.z() == Approx(lever.cross(force).z()).epsilon(0.001));
  CHECK((torque - last_vector(trace, "/stylus/0/torque")).norm() < 0.01 * torque.norm());
  CHECK(number_after(bridge.out(), "peak torque ") >= 0.99 * torque.norm());
}

TEST_CASE("torque: a device that renders none gets none, and the hand turns as scripted") {
  const Stage stage;
  lay_rod(stage);
  stage.write("bridge.toml", "[[device]]\nscript = \"script.csv\"\nhand = {}\n");
  Server server = stage.start_server({"--lockstep", "--record", stage.path("trace.h5").string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(bridge.wait() == 0);
  REQUIRE(server.process.wait() == 0);
  CHECK(bridge.out().find("torque") == std::string::npos);
  const hdf5::File trace = hdf5::File::open(stage.path("trace.h5"));
  const Quaternion wanted(Eigen::AngleAxisd(kRodSlope, Vector3::UnitZ()));
  CHECK(last_turn(trace, "/stylus/0/orientation").angularDistance(wanted) < 1e-9);
  CHECK(last_vector(trace, "/stylus/0/torque").z() > 0.01);
}

TEST_CASE(
    "torque: a device of OpenHaptics with six actuated axes shows a tool's, none in free air") {
  if (!kKeepsPace) return leave_out(kTooSlow);
  const DeviceStage device;
  lay_rod(device.stage);
  device.stage.write("bridge.toml", "[[device]]\ntype = \"openhaptics\"\n");
  device.stage.write("motion.txt",
                     "0 0 100 0 0\n1000 0 100 0 0\n1500 0 -5 0 0\n3000 0 -5 0 0\n3500 0 100 0 0\n");
  std::vector<std::string> environment = DeviceStage::in_contact("tell", 300);
  environment.emplace_back("FAKE_HD_TORQUE=500");
  Server server = device.stage.start_server();
  ChildProcess bridge = device.stage.start_bridge(server, {}, device.with(environment));
  bridge.line_with("in contact");
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  CHECK_THAT(bridge.out(), ContainsSubstring("peak torque"));
  CHECK(device.misuses() == "misuses 0 \n");
  // The rod lies on the plane, level: about its end it turns up.
  // While it lands, a busy machine's late steps turn it either way.
  double upwards = 0.0;
  double largest = 0.0;
  for (const Frame& frame : device.frames()) {
    if (frame.tick < 1000) REQUIRE(frame.torque.norm() < 1e-3);  // at rest above the plane
    upwards = std::max(upwards, frame.torque.z());
    largest = std::max(largest, frame.torque.norm());
  }
  CHECK(upwards > 0.01);
  CHECK(largest < 0.15 * (1.0 + 1e-9));
  CHECK(device.frames().back().torque.isZero(0.0));
}

TEST_CASE("torque: killed server, force and torque are gone within 50 ms", "[slow]") {
  const Stage stage;
  lay_rod(stage);
  std::string script = file_content(stage.path("script.csv"));
  script.replace(script.find("\n3.0,"), 5, "\n100.0,");
  stage.write("script.csv", script);
  std::filesystem::path path;
  for (int after_ms = 2000; path.empty() && after_ms < 60'000; after_ms += 2000) {
    path = kill_server(stage, after_ms);
  }
  REQUIRE_FALSE(path.empty());
  const hdf5::File file = hdf5::File::open(path);
  CHECK(file.read_string_attribute("/", "fault") == "connection lost with a force");
  const std::vector<double> time = file.read<double>("/tick/0/time", {0});
  const std::vector<double> force = lengths(file, "/tick/0/force");
  const std::vector<double> torque = lengths(file, "/tick/0/torque");
  const auto end =
      static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), 0.05) - time.begin());
  REQUIRE(end < time.size());
  CHECK(*std::max_element(force.begin(), force.end()) > 0.1);
  CHECK(*std::max_element(torque.begin(), torque.end()) > 0.01);
  for (std::size_t i = end; i < time.size(); ++i) {
    REQUIRE(force[i] == 0.0);
    REQUIRE(torque[i] == 0.0);
  }
}
