#include <csignal>

#include "tests/support/catch.hpp"
#include "tests/system/device_stage.hpp"

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;
using namespace irdm;
using namespace irdm::test;

namespace {

const char* const kTable = "[[device]]\ntype = \"openhaptics\"\n";

// A report of the fake driver's device, signed off.
std::string signed_off(const std::string& device = "Touch, serial number fake-1") {
  return std::string(kTable) + "[device.report]\ndevice = \"" + device +
         "\"\ndate = \"2026-11-27\"\n[device.measured]\nmax_force = 3.3\n[[device.step]]\n"
         "name = \"driver\"\nverdict = \"passed\"\n";
}

}  // namespace

TEST_CASE("commission: without anybody at the terminal no step begins, and the report says so") {
  const DeviceStage device;
  const std::string report = device.stage.path("report.toml").string();
  const std::string command = "exec " IRDM_BRIDGE " commission --config " +
                              device.stage.path("bridge.toml").string() + " --out " + report +
                              " < /dev/null";
  const FinishedProgram program = run_to_end({"/bin/sh", "-c", command}, device.with());
  CHECK(program.status == 1);
  CHECK_THAT(program.out, ContainsSubstring("passed: driver: ") &&
                              ContainsSubstring("stopped: axis right: ended by the person") &&
                              ContainsSubstring("not reached: ramp"));
  CHECK_THAT(program.err, ContainsSubstring("irdm-bridge: error: commission: not signed off"));
  CHECK_THAT(file_content(report), ContainsSubstring("device = \"Touch, serial number fake-1\""));
  CHECK_THAT(device.misuses(), StartsWith("misuses 0 \n") && EndsWith("misuses 0 \n"));
  device.stage.write("bridge.toml", std::string(kTable) + "commissioned = \"report.toml\"\n");
  const FinishedProgram bridge = run_to_end(
      {IRDM_BRIDGE, device.stage.path("bridge.toml").string(), "--server", "127.0.0.1:1"},
      device.with());
  CHECK(bridge.status == 1);
  CHECK_THAT(bridge.err, ContainsSubstring("report.toml") && ContainsSubstring("not signed off"));
}

TEST_CASE("a real device without a report gets at most 1 N, and the bridge says what to do") {
  const DeviceStage device;
  Server server = device.stage.start_server();
  ChildProcess bridge =
      device.stage.start_bridge(server, {}, device.with(DeviceStage::in_contact("tell", 500)));
  CHECK_THAT(bridge.line_with("not commissioned", true),
             ContainsSubstring("at most 1 N") && ContainsSubstring("irdm-bridge commission"));
  bridge.line_with("in contact");
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  double largest = 0.0;
  for (const Frame& frame : device.frames()) largest = std::max(largest, frame.force);
  CHECK(largest > 0.5);
  CHECK(largest < 1.0 + 1e-9);
}

TEST_CASE(
    "a real device with its report gets as much as configured, with another's it is refused") {
  const DeviceStage device;
  device.stage.write("bridge.toml", std::string(kTable) + "commissioned = \"report.toml\"\n");
  device.stage.write("report.toml", signed_off());
  Server server = device.stage.start_server();
  ChildProcess bridge =
      device.stage.start_bridge(server, {}, device.with(DeviceStage::in_contact("tell", 500)));
  bridge.line_with("in contact");
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  CHECK_THAT(bridge.err(), !ContainsSubstring("commission"));
  device.stage.write("report.toml", signed_off("Touch, serial number fake-2"));
  const FinishedProgram other = run_to_end(
      {IRDM_BRIDGE, device.stage.path("bridge.toml").string(), "--server", "127.0.0.1:1"},
      device.with());
  CHECK(other.status == 1);
  CHECK_THAT(other.err, ContainsSubstring("its report is that of another device"));
}

TEST_CASE("commission: what is to be killed pushes the handle up with 0.5 N, and ends in order") {
  const DeviceStage device;
  ChildProcess bridge(
      {IRDM_BRIDGE, "commission", "--config", device.stage.path("bridge.toml").string(), "--push"},
      device.with(DeviceStage::in_contact("tell", 1200)));
  bridge.line_with("in contact");
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  double largest = 0.0;
  for (const Frame& frame : device.frames()) largest = std::max(largest, frame.force);
  CHECK(largest == Approx(0.5).epsilon(1e-3));
  CHECK(device.frames().back().force == 0.0);
}
