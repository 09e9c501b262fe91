#include <catch2/catch.hpp>
#include <csignal>

#include "tests/system/stage.hpp"

using Catch::Matchers::Contains;
using namespace irdm::test;

namespace {

FinishedProgram check_link(const Server& server) {
  return run_to_end({IRDM_BRIDGE, "check-link", "--server",
                     "127.0.0.1:" + std::to_string(server.port), "--duration", "0.5"});
}

}  // namespace

TEST_CASE("check-link measures a running server and says what it thinks of it") {
  const Stage stage;
  Server server = stage.start_server({"--no-viewer"});
  const FinishedProgram check = check_link(server);
  CAPTURE(check.out, check.err);
  CHECK(number_after(check.out, "link: ") >= 0.5);
  CHECK(number_after(check.out, "success: ") > 0.0);
  CHECK_THAT(check.out, Contains("round trip: p50 ") && Contains("jitter: p50 "));
  // How good it is depends on what else this machine does.
  const bool bad = check.out.find("verdict: bad") != std::string::npos;
  CHECK(check.status == (bad ? 1 : 0));
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  CHECK_THAT(server.process.out(), Contains("peak force: 0.000 N"));
}

TEST_CASE("check-link measures a stream of datagrams") {
  const Stage stage;
  stage.write("scene.toml", "[server]\nudp = true\n" + scene_text().substr(9));
  Server server = stage.start_server({"--no-viewer"});
  stage.write(
      "link.toml",
      "[bridge]\nstream = \"udp\"\n[[device]]\ntype = \"virtual\"\nscript = \"script.csv\"\n");
  stage.write("script.csv", press_and_swing());
  const FinishedProgram check =
      run_to_end({IRDM_BRIDGE, "check-link", "--config", stage.path("link.toml").string(),
                  "--server", "127.0.0.1:" + std::to_string(server.port), "--duration", "0.5"});
  CAPTURE(check.out, check.err);
  CHECK(number_after(check.out, "success: ") > 0.0);
  CHECK(number_after(check.out, "datagrams: ") > 0.0);
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
}

TEST_CASE("a server tells in its log how the run goes") {
  const Stage stage;
  stage.write("scene.toml", "[server]\nstatus_period = 1\n" + scene_text().substr(9));
  Server server = stage.start_server({"--no-viewer"});
  CHECK_THAT(server.process.line_with("status: "),
             Contains(" steps, step p50 ") && Contains(", wake-up p50 ") &&
                 Contains(", overruns ") && Contains(", lost in full queues 0") &&
                 Contains(" surfaces/s, sessions 0"));
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
}

TEST_CASE("check-link of a server in lockstep, of none, or without a name is one line, status 1") {
  const Stage stage;
  Server server = stage.start_server({"--no-viewer", "--lockstep"});
  const FinishedProgram lockstep = check_link(server);
  CHECK(lockstep.status == 1);
  CHECK_THAT(lockstep.err, Contains("the server runs in lockstep"));
  const FinishedProgram nameless = run_to_end({IRDM_BRIDGE, "check-link"});
  CHECK(nameless.status == 1);
  CHECK_THAT(nameless.err, Contains("no server is named"));
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  const FinishedProgram none = check_link(server);
  CHECK(none.status == 1);
  CHECK_THAT(none.err, Contains("nothing was measured"));
}
