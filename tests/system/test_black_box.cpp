#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "common/geometry.hpp"
#include "common/hdf5/file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/raw_peer.hpp"
#include "tests/system/device_stage.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

/// The black box of a program in the folder that it ran in, of that kind of fault if one is named;
/// empty when there is none in time.
std::filesystem::path find_black_box(const Stage& stage, const std::string& program,
                                     int deadline_ms, const std::string& fault = "") {
  std::filesystem::path found;
  const auto there = [&] {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(stage.path("blackbox"), ignored)) {
      const std::string name = entry.path().filename().string();
      if (!name.starts_with(program) || !name.ends_with(".h5")) continue;
      if (fault.empty() ||
          hdf5::File::open(entry.path()).read_string_attribute("/", "fault") == fault) {
        found = entry.path();
      }
    }
    return !found.empty();
  };
  eventually(there, deadline_ms);
  return found;
}

hdf5::File black_box(const Stage& stage, const std::string& program,
                     const std::string& fault = "") {
  const std::filesystem::path found = find_black_box(stage, program, kDeadlineMs, fault);
  REQUIRE_FALSE(found.empty());
  return hdf5::File::open(found);
}

/// Kills the server or the bridge a while after the hand has begun to reach for the cube, and tells
/// what the other leaves. Nothing when the hand did not hold it yet: then nothing has gone wrong.
std::filesystem::path kill_in_contact(const Stage& stage, bool server_dies, int after_ms) {
  constexpr int kSoonMs = 3000;
  Server server = stage.start_server({}, {.folder = stage.path("")});
  ChildProcess bridge = stage.start_bridge(server, {}, {.folder = stage.path("")});
  bridge.line_with("session ", true);
  ChildProcess& victim = server_dies ? server.process : bridge;
  std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
  victim.signal(SIGKILL);
  victim.wait();
  return find_black_box(stage, server_dies ? "irdm-bridge-" : "irdm-server-", kSoonMs);
}

std::vector<double> lengths(const std::vector<double>& vectors) {
  std::vector<double> found;
  for (std::size_t i = 0; i < vectors.size(); i += 3) {
    found.push_back(Vector3(vectors.data() + i).norm());
  }
  return found;
}

bool any_black_box(const Stage& stage) {
  return std::filesystem::exists(stage.path("blackbox"));
}

/// Runs server and bridge for a second that ends in contact. Returns whether force steps stopped in
/// contact for so long that this is a fault of its own, as they may on a busy machine.
bool stalled_in_a_run_that_is_well() {
  const Stage stage;
  stage.write("script.csv", hold_and_circle());
  if (!kKeepsPace) stage.hold_forces();
  Server server = stage.start_server({}, {.folder = stage.path("")});
  ChildProcess bridge = stage.start_bridge(server, {"--duration", "1"}, {.folder = stage.path("")});
  CHECK(bridge.wait() == 0);
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  if (!any_black_box(stage)) return false;
  CHECK(find_black_box(stage, "irdm-bridge-", 0).empty());
  const hdf5::File file = black_box(stage, "irdm-server-");
  CHECK(file.read_string_attribute("/", "fault") == "force steps stopped in contact");
  return true;
}

}  // namespace

// Those with the tag need a connection that stays until the fault: not where a sanitizer makes the
// programs ten times slower.
TEST_CASE("black box: a device that fails in contact leaves two seconds of ticks and frames",
          "[slow]") {
  const DeviceStage device;
  device.stage.hold_forces();
  Server server = device.stage.start_server({}, {.folder = device.stage.path("")});
  ChildOptions options = device.with(DeviceStage::in_contact("0x0204", 2100));
  options.folder = device.stage.path("");
  ChildProcess bridge = device.stage.start_bridge(server, {}, options);
  // Of a busy machine there may be others before it: connections that were lost with a force.
  const hdf5::File file = black_box(device.stage, "irdm-bridge-", "device failed");
  CHECK_THAT(bridge.line_with("device failed: stylus 0: the last seconds are in", true),
             ContainsSubstring("blackbox/irdm-bridge-"));
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);

  const std::vector<double> time = file.read<double>("/tick/0/time", {0});
  const hsize_t rows = time.size();
  CHECK(std::is_sorted(time.begin(), time.end()));
  CHECK(time.back() > 0.0);
  const std::vector<std::uint8_t> failed = file.read<std::uint8_t>("/tick/0/device_failed", {rows});
  const std::vector<std::uint8_t> state = file.read<std::uint8_t>("/tick/0/state", {rows});
  const std::vector<double> reading = file.read<double>("/tick/0/reading", {rows, 3});
  const std::vector<double> force = lengths(file.read<double>("/tick/0/force", {rows, 3}));
  const auto fault =
      static_cast<std::size_t>(std::find(time.begin(), time.end(), 0.0) - time.begin());
  REQUIRE(fault > 0);
  REQUIRE(fault < rows);
  CHECK(failed[fault - 1] == 0);
  for (std::size_t i = fault; i < rows; ++i) {
    REQUIRE(failed[i] == 1);
    REQUIRE(state[i] == 4);
  }
  CHECK(force.back() == 0.0);

  // Every tick of the two seconds, as the driver saw it, the last of them with a force.
  const std::vector<Frame> frames = device.frames();
  const auto failing = static_cast<std::size_t>(
      std::find_if(frames.begin(), frames.end(), [](const Frame& frame) { return frame.failed; }) -
      frames.begin());
  REQUIRE(failing < frames.size());
  REQUIRE(failing > fault);
  const std::size_t first = failing - fault;
  for (std::size_t i = 0; i < fault; ++i) {
    REQUIRE(1e3 * reading[3 * i + 1] == Approx(frames[first + i].height).margin(1e-9));
    REQUIRE(force[i] == Approx(frames[first + i].force).margin(1e-9));
  }
  CHECK(force[fault - 1] > 0.0);
  CHECK(time.front() >= -2.0);
  CHECK(time.front() - (frames[first].begun - frames[first - 1].begun) < -1.9);

  const std::vector<double> seen = file.read<double>("/frame/time", {0});
  const std::vector<std::int32_t> type = file.read<std::int32_t>("/frame/type", {seen.size()});
  const std::vector<std::uint8_t> linked = file.read<std::uint8_t>("/tick/0/linked", {rows});
  const auto ticks = std::count(linked.begin(), linked.end(), 1);
  std::ptrdiff_t unseen = 0;  // linked ticks before the first frame
  for (std::size_t i = 0; i < rows && time[i] < seen.front(); ++i) unseen += linked[i];
  CHECK(ticks > 0);
  CHECK(10 * unseen < ticks);
  CHECK(4 * std::count(type.begin(), type.end(), 5) > ticks);  // samples
  CHECK(8 * std::count(type.begin(), type.end(), 6) > ticks);  // forces
}

TEST_CASE("black box: a driver that hangs leaves the ticks that it made until then", "[slow]") {
  const DeviceStage device;
  Server server = device.stage.start_server();
  ChildOptions options = device.with(DeviceStage::in_contact("hang"));
  options.folder = device.stage.path("");
  ChildProcess bridge = device.stage.start_bridge(server, {}, options);
  CHECK(bridge.wait() == 3);
  const hdf5::File file = black_box(device.stage, "irdm-bridge-");
  CHECK_THAT(file.read_string_attribute("/", "fault"), ContainsSubstring("no ticks"));
  CHECK(file.shape("/tick/0/time")[0] > 50);
}

TEST_CASE("black box: garbage at the server leaves its bytes and the steps meanwhile") {
  const Stage stage;
  Server server = stage.start_server({}, {.folder = stage.path("")});
  RawPeer peer = RawPeer::connect(server.port);
  const std::string garbage = "GET / HTTP/1.1\r\nHost: nobody at all here\r\n\r\n";
  peer.send({reinterpret_cast<const std::uint8_t*>(garbage.data()), garbage.size()});
  CHECK(peer.ends());
  const hdf5::File file = black_box(stage, "irdm-server-");
  CHECK(file.read_string_attribute("/", "fault") == "protocol violation");
  const std::vector<std::uint8_t> bytes = file.read<std::uint8_t>("/frame/bytes", {0});
  CHECK_THAT(std::string(bytes.begin(), bytes.end()), ContainsSubstring("GET / HTTP/1.1"));
  const std::vector<std::uint8_t> kind = file.read<std::uint8_t>("/frame/kind", {0});
  CHECK(std::count(kind.begin(), kind.end(), 2) == 1);
  CHECK(std::count(kind.begin(), kind.end(), 4) == 1);
  CHECK(file.shape("/step/time")[0] > 0);
  CHECK(file.read<double>("/step/time", {0}).back() > 0.0);
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
}

TEST_CASE("black box: a server that is killed in contact, and then the bridge: the other tells",
          "[slow]") {
  const Stage stage;
  stage.hold_forces();
  stage.write("script.csv", hold_and_circle());
  const bool server_dies = GENERATE(true, false);
  std::filesystem::path path;
  for (int after_ms = 1500; path.empty() && after_ms < 60'000; after_ms += 1500) {
    path = kill_in_contact(stage, server_dies, after_ms);
  }
  REQUIRE_FALSE(path.empty());
  const hdf5::File file = hdf5::File::open(path);
  if (server_dies) {
    CHECK(file.read_string_attribute("/", "fault") == "connection lost with a force");
    const std::vector<double> force = lengths(file.read<double>("/tick/0/force", {0, 3}));
    CHECK(*std::max_element(force.begin(), force.end()) > 0.0);
    CHECK(force.back() == 0.0);
  } else {
    CHECK(file.read_string_attribute("/", "fault") == "stylus lost in contact");
    const std::vector<std::uint8_t> present =
        file.read<std::uint8_t>("/step/stylus/0/present", {0});
    CHECK(std::count(present.begin(), present.end(), 1) > 100);
    CHECK(present.back() == 0);
  }
}

TEST_CASE(
    "black box: none after a run in which nothing went wrong, and none where there is no folder") {
  const Stage stage;
  stage.write("script.csv", hold_and_circle());
  SECTION("all is well, and the bridge ends in contact") {
    constexpr int kMostRuns = 20;
    int runs = 1;
    while (stalled_in_a_run_that_is_well() && runs < kMostRuns) ++runs;
    CHECK(runs < kMostRuns);
  }
  SECTION("no folder is wanted") {
    std::string scene = scene_text();
    scene.replace(scene.find("port = 0"), 8, "port = 0\nblack_box = \"\"");
    stage.write("scene.toml", scene);
    Server server = stage.start_server({}, {.folder = stage.path("")});
    RawPeer peer = RawPeer::connect(server.port);
    const std::vector<std::uint8_t> garbage(100, 7);
    peer.send(garbage);
    CHECK(peer.ends());
    server.process.signal(SIGTERM);
    CHECK(server.process.wait() == 0);
    CHECK_FALSE(any_black_box(stage));
  }
  SECTION("the folder cannot be made: one line, and the server goes on") {
    stage.write("blackbox", "in the way");
    Server server = stage.start_server({}, {.folder = stage.path("")});
    RawPeer peer = RawPeer::connect(server.port);
    const std::vector<std::uint8_t> garbage(100, 7);
    peer.send(garbage);
    CHECK(peer.ends());
    CHECK_THAT(server.process.line_with("no black box", false), ContainsSubstring("black_box"));
    server.process.signal(SIGTERM);
    CHECK(server.process.wait() == 0);
  }
}
