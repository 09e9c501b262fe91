#include <csignal>

#include "tests/support/catch.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
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
  CHECK_THAT(check.out, ContainsSubstring("round trip: p50 ") && ContainsSubstring("jitter: p50 "));
  // How good it is depends on what else this machine does.
  const bool bad = check.out.find("verdict: bad") != std::string::npos;
  CHECK(check.status == (bad ? 1 : 0));
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  CHECK_THAT(server.process.out(), ContainsSubstring("peak force: 0.000 N"));
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
             ContainsSubstring(" steps, step p50 ") && ContainsSubstring(", wake-up p50 ") &&
                 ContainsSubstring(", overruns ") && ContainsSubstring(", lost in full queues 0") &&
                 ContainsSubstring(" surfaces/s, sessions 0"));
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
}

TEST_CASE("check-link of a server in lockstep, of none, or without a name is one line, status 1") {
  const Stage stage;
  Server server = stage.start_server({"--no-viewer", "--lockstep"});
  const FinishedProgram lockstep = check_link(server);
  CHECK(lockstep.status == 1);
  CHECK_THAT(lockstep.err, ContainsSubstring("the server runs in lockstep"));
  const FinishedProgram nameless = run_to_end({IRDM_BRIDGE, "check-link"});
  CHECK(nameless.status == 1);
  CHECK_THAT(nameless.err, ContainsSubstring("no server is named"));
  server.process.signal(SIGTERM);
  CHECK(server.process.wait() == 0);
  const FinishedProgram none = check_link(server);
  CHECK(none.status == 1);
  CHECK_THAT(none.err, ContainsSubstring("nothing was measured"));
}
