#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>

#include "tests/c_interface/c_scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/real_time_guard.hpp"

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

// In real time, with the scene of CScene.
struct RealTimeServer {
  explicit RealTimeServer(const std::string& port = "0")
      : file((folder.path() / "scene.toml").string()),
        program({IRDM_SERVER, write(file, port, scene), "--no-viewer"}),
        line(program.line_with("listening on ")),
        address(line.substr(line.rfind(' ') + 1)) {}

  static std::string write(const std::string& file, const std::string& port, const CScene& scene) {
    std::ofstream(file) << "server.port = " << port << "\nserver.black_box = \"\"\n"
                        << scene.text();
    return file;
  }

  CScene scene;
  TemporaryFolder folder;
  std::string file;
  ChildProcess program;
  std::string line;
  std::string address;
};

// Beside the cube, whose side is 6 cm from the middle.
irdm_command beside(double x) {
  irdm_command command{};
  command.present = 1;
  command.tip[0] = x;
  command.tip[1] = 0.06;
  return command;
}

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
    CHECK_THAT(connected.error, Catch::Matchers::ContainsSubstring(expected));
  }
}

TEST_CASE("C interface: a program is a stylus of a server in real time") {
  const RealTimeServer server;
  const Connected stylus(server.address.c_str(), "tip = [0, 0.5, 0]\nstylus = 0");
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
  CHECK_THAT(std::string(state.data()), Catch::Matchers::StartsWith("ready"));
}

namespace {

// A tip that comes from the side and presses; what is shown to it, judged by the ticks that showed
// it.
struct Pressing {
  // The force of the newest tick [N].
  double look() {
    const irdm_command command = beside(x = std::max(0.056, x - 5e-5));
    irdm_stylus_set(stylus.handle, &command);
    irdm_stylus_get(stylus.handle, &feedback);
    const double force = std::hypot(feedback.force[0], feedback.force[1], feedback.force[2]);
    if (force == 0.0) {
      silent = feedback.time;
    } else {
      steepest = std::max(steepest, force / (feedback.time - silent));
    }
    return force;
  }
  bool pressed() {
    return eventually([&] { return look() > 0.3; });
  }
  // Until there is no force; how many ticks were seen that had one.
  int fade() {
    int faded = 0;
    REQUIRE(eventually([&] {
      if (look() == 0.0) return true;
      oldest = std::max(oldest, feedback.latency);
      ++faded;
      return false;
    }));
    return faded;
  }

  const Connected& stylus;
  irdm_feedback feedback{};
  double x = 0.2;
  double oldest = 0.0;    // tip that a force answered while it faded [s]
  double silent = 0.0;    // last tick without force [s]
  double steepest = 0.0;  // force by the time since then [N/s]
};

}  // namespace

TEST_CASE("C interface: the force is gone 50 ms after the server, and comes back as a ramp") {
  constexpr double kGone = 0.05;  // [s]
  constexpr double kTick = 1e-3;  // [s]
  constexpr double kMost = 3.3;   // max_force by default [N]
  constexpr double kRamp = 0.5;   // in which a force comes back [s]
  auto server = std::make_unique<RealTimeServer>();
  const std::string port = server->address.substr(server->address.rfind(':') + 1);
  const Connected stylus(server->address.c_str(), "tip = [0.2, 0.06, 0]\nmode = \"hold\"");
  INFO(stylus.error);
  REQUIRE(stylus.status == IRDM_OK);
  Pressing hand{stylus};
  // A machine that stands still for so long shows nothing of it: again, then.
  REQUIRE(eventually([&] {
    REQUIRE(hand.pressed());
    server->program.signal(SIGSTOP);
    const int faded = hand.fade();
    hand.steepest = 0.0;
    server->program.signal(SIGCONT);
    return faded > 0;
  }));
  REQUIRE(hand.pressed());
  CHECK(hand.steepest > 0.0);
  CHECK(hand.steepest < 1.000001 * kMost / kRamp);
  server->program.signal(SIGKILL);
  hand.fade();
  CHECK(hand.oldest <= kGone + kTick);
  server.reset();
  server = std::make_unique<RealTimeServer>(port);
  hand.x = 0.2;  // a tip that is inside from the start touches nothing
  REQUIRE(hand.pressed());
  CHECK(hand.feedback.sessions == 2);
}

TEST_CASE("C interface: setting and getting neither allocates nor locks", "[unsanitized]") {
  const RealTimeServer server;
  const Connected stylus(server.address.c_str(), "tip = [0.2, 0.06, 0]");
  REQUIRE(stylus.status == IRDM_OK);
  irdm_feedback feedback{};
  irdm_command wrong = beside(0.2);
  wrong.tip[2] = std::numeric_limits<double>::quiet_NaN();
  std::string done;
  std::string control;
  std::array<char, 128> state{};
  {
    const RealTimeGuard guard;
    for (int k = 0; k < 20'000; ++k) {
      const irdm_command command = beside(0.2 - 1e-6 * k);
      irdm_stylus_set(stylus.handle, &command);
      irdm_stylus_set(stylus.handle, &wrong);
      irdm_stylus_get(stylus.handle, &feedback);
    }
    done = guard.violations();
    irdm_stylus_state(stylus.handle, state.data(), state.size());
    control = guard.violations();
  }
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  CHECK(done.empty());
  CHECK_FALSE(control.empty());
}
