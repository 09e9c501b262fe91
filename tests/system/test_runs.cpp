#include <csignal>

#include <algorithm>

#include "common/checksum.hpp"
#include "common/hdf5/file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/left_out.hpp"
#include "tests/system/one_session.hpp"
#include "tests/system/stage.hpp"
#include "tests/system/trace.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kTouching = 1;
constexpr int kHolding = 2;

std::size_t rows_in(const Trace& trace, int contact) {
  return static_cast<std::size_t>(std::count(trace.contact.begin(), trace.contact.end(), contact));
}

double peak_force(const Trace& trace) {
  double peak = 0.0;
  for (std::size_t k = 0; k < trace.rows(); ++k) {
    peak = std::max(peak, trace.vector("/stylus/0/force", k).norm());
  }
  return peak;
}

// A trace that lacks nothing: as many rows as the server says, numbered from 0.
void check_whole(const Trace& trace, const std::string& server_output) {
  CHECK(static_cast<double>(trace.rows()) == number_after(server_output, "\nsteps: "));
  CHECK(static_cast<double>(trace.rows()) == number_after(server_output, "\nrecorded: "));
  for (std::size_t k = 0; k < trace.rows(); ++k) REQUIRE(trace.force_step[k] == k);
}

void check_ended_well(ChildProcess& process) {
  CHECK(process.wait() == 0);
  CHECK_THAT(process.err(), !ContainsSubstring("error"));
}

}  // namespace

TEST_CASE("a run in real time: both end in order, and the trace says what they say") {
  const Stage stage;
  stage.write("bridge.toml",
              "[bridge]\nmode = \"predict\"\n"
              "[[device]]\ntype = \"virtual\"\nscript = \"script.csv\"\n"
              "hand = { mass = 0.12, damping = 2.0, stiffness = 300.0 }\n");
  Server server = stage.start_server({"--record", stage.path("trace.h5").string()});
  ChildProcess bridge = stage.start_bridge(server);
  check_ended_well(bridge);
  server.process.signal(SIGTERM);
  check_ended_well(server.process);

  const Trace trace = read_trace(stage.path("trace.h5"));
  check_whole(trace, server.process.out());
  CHECK(trace.model_file == cube_model().filename());
  CHECK(trace.model_checksum == sha256_of_file(cube_model()));
  CHECK(trace.scene == file_content(stage.path("scene.toml")));
  CHECK(std::abs(peak_force(trace) - number_after(server.process.out(), "peak force: ")) <= 5e-4);
  CHECK(number_after(server.process.out(), "steps without a finite solution: ") == 0);
  CHECK(number_after(server.process.out(), "sessions: ") ==
        number_after(bridge.out(), "sessions "));
  CHECK_THAT(server.process.out(), ContainsSubstring(" accepted, 0 refused, 0 closed"));
  check_one_session(bridge.out());
  CHECK(number_after(bridge.out(), "forces: ") > 0);
  CHECK(number_after(bridge.out(), "contact models: ") > 10);
  CHECK_THAT(bridge.out(), ContainsSubstring(" 0 invalid"));
  if (!kKeepsPace) return leave_out(kTooSlow);
  CHECK(rows_in(trace, kTouching) > 0);
  CHECK(rows_in(trace, kHolding) > 0);
  CHECK(number_after(bridge.out(), "peak force: ") > 0.1);
}

TEST_CASE("a run in real time whose bridge holds the server's forces") {
  const Stage stage;
  stage.hold_forces();
  Server server = stage.start_server({});
  ChildProcess bridge = stage.start_bridge(server);
  check_ended_well(bridge);
  server.process.signal(SIGTERM);
  check_ended_well(server.process);
  CHECK_THAT(bridge.out(), !ContainsSubstring("contact models"));
  if (!kKeepsPace) return leave_out(kTooSlow);
  CHECK(number_after(bridge.out(), "peak force: ") > 0.1);
}

TEST_CASE("a run in real time with columns of R from the disk, as many as a finger needs") {
  const Stage stage;
  stage.write("scene.toml", scene_text("", "dense") + "memory_budget = 8\n");
  Server server = stage.start_server({"--record", stage.path("trace.h5").string()});
  ChildProcess bridge = stage.start_bridge(server);
  check_ended_well(bridge);
  server.process.signal(SIGTERM);
  check_ended_well(server.process);
  const std::string said = server.process.out();
  CHECK_THAT(said, ContainsSubstring(", cache misses: ") && !ContainsSubstring("cannot be read"));
  // A program that is late takes fewer samples of the tip's path and touches fewer nodes.
  CHECK(number_after(said, "nodes whose columns were read: ") > 0);
  CHECK(number_after(said, "steps without a finite solution: ") == 0);
  check_whole(read_trace(stage.path("trace.h5")), said);
  if (!kKeepsPace) return leave_out(kTooSlow);
  CHECK(number_after(bridge.out(), "peak force: ") > 0.1);
}

TEST_CASE("a budget that is too small for a finger is refused") {
  const Stage stage;
  stage.write("scene.toml", scene_text("", "dense") + "memory_budget = 4\n");
  ChildProcess server({IRDM_SERVER, stage.path("scene.toml").string()});
  CHECK(server.wait() == 1);
  CHECK_THAT(server.err(), ContainsSubstring("memory_budget of 4 MiB is too small") &&
                               ContainsSubstring("the columns of 12 nodes need 8 MiB; raise it"));
}

TEST_CASE("a server runs for its duration, to the step, and tells the bridge when it ends") {
  const Stage stage;
  stage.write("script.csv", hold_and_circle());
  const bool lockstep = GENERATE(true, false);
  CAPTURE(lockstep);
  std::vector<std::string> arguments{"--record", stage.path("trace.h5").string(), "--duration",
                                     "0.301"};
  if (lockstep) arguments.push_back("--lockstep");
  Server server = stage.start_server(arguments);
  ChildProcess bridge = stage.start_bridge(server);
  check_ended_well(server.process);
  if (!lockstep) bridge.signal(SIGTERM);  // it would wait for another server
  CHECK(bridge.wait() == 0);
  const Trace trace = read_trace(stage.path("trace.h5"));
  CHECK(trace.rows() == 151);
  CHECK(trace.time.back() == Approx(0.302));
  check_whole(trace, server.process.out());
}

TEST_CASE("SIGINT and SIGTERM, to either of them first, leave a whole trace and status 0") {
  const Stage stage;
  stage.hold_forces();
  stage.write("script.csv", hold_and_circle());
  const std::filesystem::path path = stage.path("trace.h5");
  const int number = GENERATE(SIGINT, SIGTERM);
  const bool server_first = GENERATE(true, false);
  CAPTURE(number, server_first);
  Server server = stage.start_server({"--record", path.string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(eventually([&] { return rows_so_far(path, "contact", kHolding) > 50; }));
  ChildProcess& first = server_first ? server.process : bridge;
  ChildProcess& second = server_first ? bridge : server.process;
  first.signal(number);
  check_ended_well(first);
  CHECK(second.running());
  second.signal(number);
  check_ended_well(second);
  check_one_session(bridge.out());
  const Trace trace = read_trace(path);
  check_whole(trace, server.process.out());
  CHECK(rows_in(trace, kHolding) > 50);
}

TEST_CASE("a file that exists is not recorded over") {
  const Stage stage;
  const std::string before = "a trace, perhaps";
  stage.write("trace.h5", before);
  const FinishedProgram server = run_to_end({IRDM_SERVER, stage.path("scene.toml").string(),
                                             "--record", stage.path("trace.h5").string()});
  CHECK(server.status == 1);
  CHECK(server.err == "irdm-server: error: " + stage.path("trace.h5").string() +
                          ": exists already; choose another name or remove it\n");
  CHECK(server.out.empty());
  CHECK(file_content(stage.path("trace.h5")) == before);
}

TEST_CASE("a server that nobody comes to is stopped in order, in real time and in lockstep") {
  const Stage stage;
  const bool lockstep = GENERATE(true, false);
  std::vector<std::string> arguments{"--record", stage.path("trace.h5").string()};
  if (lockstep) arguments.push_back("--lockstep");
  Server server = stage.start_server(arguments);
  server.process.signal(SIGTERM);
  check_ended_well(server.process);
  const Trace trace = read_trace(stage.path("trace.h5"));
  check_whole(trace, server.process.out());
  if (lockstep) CHECK(trace.rows() == 0);
}

// Sanitizers add lines of their own, and that for threads maps files larger than the limit.
#ifndef IRDM_SANITIZED
TEST_CASE("a disk that gets full is told in one line at the end, with status 1") {
  const Stage stage;
  stage.write("script.csv", hold_and_circle());
  // No file of the server may grow beyond 100 kB; a second of its trace needs more.
  const std::string limited = "trap '' XFSZ; ulimit -f 200; exec \"$0\" \"$@\"";
  const FinishedProgram server =
      run_to_end({"/bin/sh", "-c", limited, IRDM_SERVER, stage.path("scene.toml").string(),
                  "--record", stage.path("trace.h5").string(), "--duration", "2"});
  CHECK(server.status == 1);
  CHECK(std::count(server.err.begin(), server.err.end(), '\n') == 1);
  CHECK_THAT(server.err,
             Catch::Matchers::StartsWith("irdm-server: error: recording ended early: ") &&
                 ContainsSubstring("trace.h5") && ContainsSubstring("check free space"));
  CHECK(number_after(server.out, "\nsteps: ") == 1000);
  CHECK(hdf5::File::open(stage.path("trace.h5")).exists("/committed"));
}
#endif
