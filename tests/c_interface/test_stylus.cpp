#include <catch2/catch.hpp>
#include <fstream>
#include <limits>

#include "tests/c_interface/c_scene.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/eventually.hpp"

using namespace irdm::test;

namespace {

struct Connected {
  Connected(const char* address, const char* options) {
    std::array<char, 256> message{};
    status = irdm_stylus_connect(address, options, &handle, message.data(), message.size());
    error = message.data();
  }
  Connected(const Connected&) = delete;
  Connected& operator=(const Connected&) = delete;
  ~Connected() { irdm_stylus_close(handle); }

  irdm_stylus_client* handle = nullptr;
  irdm_status status = IRDM_FAILED;
  std::string error;
};

irdm_command at(double y) {
  irdm_command command{};
  command.present = 1;
  command.tip[1] = y;
  return command;
}

}  // namespace

TEST_CASE("C interface: a stylus client that is used wrongly says so") {
  irdm_feedback feedback{};
  const irdm_command command = at(0.1);
  std::array<char, 8> text{};
  irdm_stylus_client* client = nullptr;
  CHECK(irdm_stylus_connect(nullptr, nullptr, &client, nullptr, 0) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_stylus_connect("localhost:1", nullptr, nullptr, nullptr, 0) == IRDM_BAD_ARGUMENT);
  irdm_stylus_close(nullptr);
  CHECK(irdm_stylus_set(nullptr, &command) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_stylus_get(nullptr, &feedback) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_stylus_step(nullptr, &command, &feedback) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_stylus_state(nullptr, text.data(), text.size()) == IRDM_BAD_ARGUMENT);
  const std::array<std::array<const char*, 3>, 5> wrong{{
      {"localhost", "tip = [0, 0, 0]", "has no port"},
      {"127.0.0.1:1", nullptr, "tip is missing"},
      {"127.0.0.1:1", "tip = [0, 0, 0]\ncolour = 1", "colour"},
      {"127.0.0.1:1", "tip = [0,", "options"},
      {"127.0.0.1:1", "tip = [0, 0, 0]\ntimeout = 0.1", "no connection"},
  }};
  for (const auto& [address, options, expected] : wrong) {
    const Connected connected(address, options);
    CHECK(connected.status == IRDM_FAILED);
    CHECK(connected.handle == nullptr);
    CHECK_THAT(connected.error, Catch::Contains(expected));
  }
}

TEST_CASE("C interface: a program is a stylus of a server in real time") {
  const CScene scene;
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "scene.toml").string();
  std::ofstream(file) << "server.port = 0\nserver.black_box = \"\"\n" << scene.text();
  ChildProcess server({IRDM_SERVER, file, "--no-viewer"});
  const std::string line = server.line_with("listening on ");
  const std::string address = line.substr(line.rfind(' ') + 1);
  const Connected stylus(address.c_str(), "tip = [0, 0.5, 0]\nstylus = 0");
  INFO(stylus.error);
  REQUIRE(stylus.status == IRDM_OK);
  for (const double y : {std::numeric_limits<double>::quiet_NaN(), 2.1}) {
    const irdm_command wrong = at(y);
    CHECK(irdm_stylus_set(stylus.handle, &wrong) == IRDM_BAD_ARGUMENT);
  }
  const irdm_command nobody{};
  CHECK(irdm_stylus_set(stylus.handle, &nobody) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_stylus_set(stylus.handle, nullptr) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_stylus_get(stylus.handle, nullptr) == IRDM_BAD_ARGUMENT);
  CHECK(irdm_stylus_step(stylus.handle, &nobody, nullptr) == IRDM_BAD_ARGUMENT);
  irdm_feedback feedback{};
  const irdm_command command = at(0.5);
  REQUIRE(eventually([&] {
    irdm_stylus_set(stylus.handle, &command);
    irdm_stylus_get(stylus.handle, &feedback);
    return feedback.ready != 0;
  }));
  CHECK(feedback.sessions == 1);
  CHECK(feedback.ticks > 50);
  CHECK(feedback.latency >= 0.0);
  std::array<char, 128> state{};
  CHECK(irdm_stylus_state(stylus.handle, state.data(), state.size()) == IRDM_OK);
  CHECK_THAT(std::string(state.data()), Catch::StartsWith("ready"));
}
