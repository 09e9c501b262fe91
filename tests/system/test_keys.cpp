#include <csignal>

#include "tests/support/catch.hpp"
#include "tests/system/stage.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm::test;

namespace {

namespace fs = std::filesystem;

/// A stage whose server and bridge read a key each.
class KeyStage : public Stage {
 public:
  KeyStage(char servers, char bridges) {
    write_key("server.key", servers);
    write_key("bridge.key", bridges);
    write("scene.toml", "[server]\nkey_file = \"server.key\"\n" + scene_text().substr(9));
    write("bridge.toml",
          "[bridge]\nkey_file = \"bridge.key\"\n[[device]]\nscript = \"script.csv\"\n");
  }

 private:
  void write_key(const std::string& name, char digit) const {
    std::string line(64, digit);
    line.push_back('\n');
    write(name, line);
    fs::permissions(path(name), fs::perms::owner_read | fs::perms::owner_write);
  }
};

int end(ChildProcess& server) {
  server.signal(SIGTERM);
  return server.wait();
}

}  // namespace

TEST_CASE("server and bridge with the same key play") {
  const KeyStage stage('a', 'a');
  Server server = stage.start_server();
  ChildProcess bridge = stage.start_bridge(server, {"--duration", "0.5"});
  CHECK(bridge.wait() == 0);
  CHECK(end(server.process) == 0);
  CHECK_THAT(bridge.out(), ContainsSubstring("protocol errors 0"));
  CHECK(number_after(bridge.out(), "forces: ") > 10);
  CHECK_THAT(server.process.out(), !ContainsSubstring("without the server's key"));
}

TEST_CASE("a bridge with another key ends with status 1 and one line on both sides") {
  const KeyStage stage('a', 'b');
  Server server = stage.start_server();
  ChildProcess bridge = stage.start_bridge(server);
  CHECK(bridge.wait() == 1);
  CHECK_THAT(bridge.err(),
             ContainsSubstring("irdm-bridge: error: ") && ContainsSubstring("the same key file"));
  CHECK(bridge.out().empty());
  CHECK_THAT(server.process.line_with("refused: ", false),
             ContainsSubstring("not the server's key"));
  CHECK(end(server.process) == 0);
  CHECK_THAT(server.process.out(),
             ContainsSubstring("sessions: 0 accepted") &&
                 ContainsSubstring("connections without the server's key: 1"));
}

TEST_CASE("a server that others can reach does not start without a key") {
  const Stage stage;
  stage.write("scene.toml", "[server]\naddress = \"0.0.0.0\"\n" + scene_text().substr(9));
  const FinishedProgram server = run_to_end({IRDM_SERVER, stage.path("scene.toml").string()});
  CHECK(server.status == 1);
  CHECK_THAT(server.err,
             ContainsSubstring("irdm-server: error: 0.0.0.0:0: can be reached from other machines"
                               ", and there is no key; set server.key_file"));
}
