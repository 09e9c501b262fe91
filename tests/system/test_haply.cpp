#include <csignal>
#include <string>

#include "tests/haply/fake_service.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

// A bridge with a device of the fake Inverse Service, whose hand presses on the cube.
struct HaplyStage {
  HaplyStage() {
    stage.write("scene.toml",
                scene_text() + "tether = { stiffness = 200, angular_stiffness = 1 }\n");
    stage.write("bridge.toml",
                "[[device]]\ntype = \"haply\"\nname = \"049D\"\nservice = \"" + address() + "\"\n");
    service.order("hand");
  }
  std::string address() const { return "127.0.0.1:" + std::to_string(service.port()); }
  bool felt() const {
    return eventually([&] { return service.told().force.norm() > 0.5; });
  }

  FakeService service;
  Stage stage;
};

}  // namespace

TEST_CASE("a Haply device feels the server's cube, also after its service was killed") {
  if (!kKeepsPace) return leave_out(kTooSlow);
  HaplyStage haply;
  Server server = haply.stage.start_server();
  ChildProcess bridge = haply.stage.start_bridge(server);
  REQUIRE(haply.felt());
  CHECK(haply.service.told().largest < 3.3 * (1.0 + 1e-9));
  CHECK(haply.service.misuses().starts_with("0 "));
  haply.service.kill();
  bridge.line_with("no connection to the service at " + haply.address(), true);
  haply.service.start();
  haply.service.order("hand");
  REQUIRE(haply.felt());
  bridge.signal(SIGTERM);
  CHECK(bridge.wait() == 0);
  CHECK_THAT(bridge.out(), ContainsSubstring("faults 0"));
  CHECK_THAT(bridge.err(),
             ContainsSubstring("Haply device 049D: inverse3, right-handed, Inverse Service 3.5") &&
                 ContainsSubstring("answers, round trip mean"));
  CHECK(haply.service.told().force.isZero(0.0));
  CHECK(haply.service.misuses().starts_with("0 "));
}

TEST_CASE("a Haply device that cannot be had: the bridge says why in one line") {
  HaplyStage haply;
  const auto refused = [&] {
    const FinishedProgram bridge = run_to_end(
        {IRDM_BRIDGE, haply.stage.path("bridge.toml").string(), "--server", "127.0.0.1:1"});
    CHECK(bridge.status == 1);
    CHECK(bridge.out.empty());
    return bridge.err;
  };
  haply.stage.write("bridge.toml", "[[device]]\ntype = \"haply\"\nname = \"1234\"\nservice = \"" +
                                       haply.address() + "\"\n");
  CHECK_THAT(refused(),
             ContainsSubstring("irdm-bridge: error: Haply device 1234: the service has no such "
                               "device") &&
                 ContainsSubstring("found: 049D"));
  haply.service.kill();
  CHECK_THAT(refused(), ContainsSubstring("no connection to the service at " + haply.address()) &&
                            ContainsSubstring("start the Inverse Service"));
}

TEST_CASE("doctor measures how long a Haply device's service takes to answer") {
  HaplyStage haply;
  const FinishedProgram doctor =
      run_to_end({IRDM_BRIDGE, "doctor", "--config", haply.stage.path("bridge.toml").string()});
  CHECK_THAT(doctor.out, ContainsSubstring("device 0 (haply): opens") &&
                             ContainsSubstring("service of device 0: ") &&
                             ContainsSubstring("answers, 99 %"));
  haply.service.order("late 4");
  const FinishedProgram slow =
      run_to_end({IRDM_BRIDGE, "doctor", "--config", haply.stage.path("bridge.toml").string()});
  CHECK_THAT(slow.out, ContainsSubstring("warning  service of device 0: "));
}
