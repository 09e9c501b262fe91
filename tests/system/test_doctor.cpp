#include <string>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

FinishedProgram doctor(std::vector<std::string> arguments,
                       const std::vector<std::string>& environment = {}) {
  arguments.insert(arguments.begin(), {IRDM_BRIDGE, "doctor"});
  return run_to_end(arguments, {.environment = environment});
}

}  // namespace

TEST_CASE("doctor says of each thing how it is, and finds the server") {
  const Stage stage;
  Server server = stage.start_server();
  const FinishedProgram program = doctor({"--config", stage.path("bridge.toml").string(),
                                          "--server", "127.0.0.1:" + std::to_string(server.port)});
  for (const char* subject : {"device 0 (virtual): opens", "real-time priority: ",
                              "locked memory: ", "clock: ", "wake-up: ", "welcomes this bridge"}) {
    CHECK_THAT(program.out, ContainsSubstring(subject));
  }
  CHECK_THAT(program.out, !ContainsSubstring("driver: "));
  CHECK_THAT(doctor({}).out, ContainsSubstring("driver: ") && ContainsSubstring("port") &&
                                 ContainsSubstring("usb"));
  CHECK((program.status == 0) == (program.out.find("problem") == std::string::npos));
}

TEST_CASE("doctor: a driver that is missing is a problem of a bridge that needs it") {
  const Stage stage;
  stage.write("bridge.toml", "[[device]]\ntype = \"openhaptics\"\n");
  const FinishedProgram program =
      doctor({"--config", stage.path("bridge.toml").string()}, {"HD_LIBRARY=/nowhere/libHD.so"});
  CHECK(program.status == 1);
  CHECK_THAT(program.out,
             ContainsSubstring("problem  driver: ") && ContainsSubstring("/nowhere/libHD.so"));
  CHECK_THAT(program.err,
             ContainsSubstring("irdm-bridge: error: doctor: ") && ContainsSubstring("problems"));
}

TEST_CASE("doctor: a device that opens, and one that the driver refuses") {
  const Stage stage;
  stage.write("bridge.toml", "[[device]]\ntype = \"openhaptics\"\n");
  const std::string library = "HD_LIBRARY=" IRDM_FAKE_LIBHD;
  const std::vector<std::string> arguments{"--config", stage.path("bridge.toml").string()};
  CHECK_THAT(doctor(arguments, {library}).out,
             ContainsSubstring("ok       driver: libHD.so loads") &&
                 ContainsSubstring("device 0 (openhaptics): opens"));
  const FinishedProgram refused = doctor(arguments, {library, "FAKE_HD_REFUSE=0x0301"});
  CHECK(refused.status == 1);
  CHECK_THAT(refused.out,
             ContainsSubstring("problem  device 0 (openhaptics): ") && ContainsSubstring("in use"));
}

TEST_CASE("doctor: wrong usage is told as such") {
  CHECK(doctor({"--server", "127.0.0.1:1"}).status == 2);
  CHECK(doctor({"--config", "/nowhere.toml"}).status == 1);
  CHECK(run_to_end({IRDM_BRIDGE}).status == 2);
}
