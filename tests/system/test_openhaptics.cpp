#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/support/committed_so_far.hpp"
#include "tests/support/eventually.hpp"
#include "tests/system/device_stage.hpp"
#include "tests/system/trace.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

double largest_force(const std::vector<Frame>& frames) {
  double largest = 0.0;
  for (const Frame& frame : frames) largest = std::max(largest, frame.force);
  return largest;
}

}  // namespace

TEST_CASE("a device of OpenHaptics feels the server's cube, one frame a tick") {
  const DeviceStage device;
  Server server = device.stage.start_server();
  ChildProcess bridge =
      device.stage.start_bridge(server, {}, device.with(DeviceStage::in_contact("tell", 500)));
  bridge.line_with("in contact");
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  CHECK_THAT(bridge.err(),
             ContainsSubstring("Touch, serial number fake-1, at most 3.3 N, 0.88 N for long"));
  CHECK_THAT(bridge.out(),
             ContainsSubstring("scheduling the driver's own") && ContainsSubstring("faults 0"));
  CHECK(device.misuses() == "misuses 0 \n");
  const std::vector<Frame> frames = device.frames();
  REQUIRE(frames.size() > 100);
  CHECK(largest_force(frames) > 0.5);
  CHECK(largest_force(frames) < 3.3 * (1.0 + 1e-9));
  CHECK(frames.back().force == 0.0);
  for (std::size_t i = 1; i < frames.size(); ++i) REQUIRE(frames[i].tick == frames[i - 1].tick + 1);
}

TEST_CASE("a bridge with two devices of OpenHaptics outlives being stopped and continued") {
  const DeviceStage device;
  std::string scene = scene_text();
  scene.replace(scene.find("port = 0"), 8, "port = 0\nstyluses = 2");
  device.stage.write("scene.toml", scene + "tether = { stiffness = 200, angular_stiffness = 1 }\n");
  device.stage.write("bridge.toml",
                     "[[device]]\ntype = \"openhaptics\"\nname = \"Left\"\n"
                     "[[device]]\ntype = \"openhaptics\"\nname = \"Right\"\n"
                     "workspace = { position = [0.02, 0, 0] }\n");
  const std::filesystem::path path = device.stage.path("trace.h5");
  Server server = device.stage.start_server({"--record", path.string()});
  ChildProcess bridge =
      device.stage.start_bridge(server, {}, device.with({"FAKE_HD_DEVICES=Left,Right"}));
  REQUIRE(eventually([&] { return rows_so_far(path, "present", 1) > 0; }));
  // Longer than the bridge bears without a tick: it was not the driver that slept.
  constexpr std::uint64_t kStoppedSteps = 750;
  bridge.signal(SIGSTOP);
  const std::uint64_t stopped = committed_so_far(path);
  REQUIRE(eventually([&] { return committed_so_far(path) > stopped + kStoppedSteps; }));
  const std::size_t before = rows_so_far(path, "present", 1);
  bridge.signal(SIGCONT);
  // It goes on for longer than it takes to find that a driver makes no ticks.
  constexpr std::size_t kSteps = 350;
  REQUIRE(eventually([&] { return rows_so_far(path, "present", 1) > before + kSteps; }));
  CHECK(bridge.running());
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  CHECK_THAT(bridge.out(), ContainsSubstring("styluses 2"));
  CHECK(device.misuses().ends_with("misuses 0 \n"));
}

TEST_CASE("a device that is unplugged in contact: the force goes to zero, the bridge says why") {
  const DeviceStage device;
  Server server = device.stage.start_server();
  ChildProcess bridge =
      device.stage.start_bridge(server, {}, device.with(DeviceStage::in_contact("unplug")));
  CHECK(bridge.wait() == 3);
  CHECK_THAT(bridge.err(), ContainsSubstring("irdm-bridge: error: ") &&
                               ContainsSubstring("HD_COMM_ERROR") &&
                               ContainsSubstring("check power and cable"));
  CHECK_THAT(bridge.out(), ContainsSubstring("faults"));
  CHECK(device.misuses() == "misuses 0 \n");
  const std::vector<Frame> frames = device.frames();
  const auto failed =
      std::find_if(frames.begin(), frames.end(), [](const Frame& frame) { return frame.failed; });
  REQUIRE(failed != frames.begin());
  REQUIRE(failed != frames.end());
  CHECK(largest_force(frames) > 0.2);
  for (auto frame = failed; frame + 1 != frames.end(); ++frame) {
    REQUIRE((frame + 1)->force <= frame->force);
  }
  CHECK(frames.back().force == 0.0);
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
}

TEST_CASE(
    "a device that was moved too fast gets its force back after a while, and the bridge says so") {
  const DeviceStage device;
  Server server = device.stage.start_server();
  ChildProcess bridge =
      device.stage.start_bridge(server, {}, device.with(DeviceStage::in_contact("0x0203,tell")));
  CHECK_THAT(bridge.line_with("HD_EXCEEDED_MAX_VELOCITY", true),
             ContainsSubstring("no force for a moment"));
  bridge.line_with("in contact");
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  CHECK_THAT(bridge.out(), ContainsSubstring("faults 0"));
  CHECK(device.misuses() == "misuses 0 \n");
}

TEST_CASE(
    "a device that is moved too fast again and again stays without force, the bridge goes on") {
  // Three that count; one that comes while the force fades, as where the machine is busy, does not.
  const std::string faults = "0x0203,0x0203,0x0203,0x0203,0x0203,0x0203,0x0203,0x0203";
  const DeviceStage device;
  Server server = device.stage.start_server();
  ChildProcess bridge =
      device.stage.start_bridge(server, {}, device.with(DeviceStage::in_contact(faults, 20)));
  CHECK_THAT(bridge.line_with("no force any more", true),
             ContainsSubstring("HD_EXCEEDED_MAX_VELOCITY"));
  CHECK(bridge.running());
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  CHECK_THAT(bridge.out(), ContainsSubstring("faults 1"));
  const std::vector<Frame> frames = device.frames();
  CHECK(largest_force(frames) > 0.2);
  CHECK(frames.back().force == 0.0);
}

TEST_CASE("a driver that hangs ends the bridge with a word about it") {
  const DeviceStage device;
  Server server = device.stage.start_server();
  ChildProcess bridge =
      device.stage.start_bridge(server, {}, device.with(DeviceStage::in_contact("hang")));
  CHECK(bridge.wait() == 3);
  CHECK_THAT(bridge.err(), ContainsSubstring("its driver no longer makes ticks"));
}

TEST_CASE("a device that cannot be had: the bridge says why in one line") {
  const DeviceStage device;
  const auto refused = [&](std::vector<std::string> environment) {
    const FinishedProgram bridge = run_to_end(
        {IRDM_BRIDGE, device.stage.path("bridge.toml").string(), "--server", "127.0.0.1:1"},
        device.with(std::move(environment)));
    CHECK(bridge.status == 1);
    CHECK(bridge.out.empty());
    return bridge.err;
  };
  CHECK_THAT(refused({"HD_LIBRARY=/nowhere/libHD.so"}),
             ContainsSubstring("irdm-bridge: error: OpenHaptics: its library is not found") &&
                 ContainsSubstring("/nowhere/libHD.so"));
  CHECK_THAT(refused({"FAKE_HD_REFUSE=0x0301"}),
             ContainsSubstring("default device") && ContainsSubstring("in use"));
  device.stage.write("bridge.toml", "[[device]]\ntype = \"openhaptics\"\nname = \"Nobody\"\n");
  CHECK_THAT(refused({}), ContainsSubstring("device 'Nobody': "));
}
