// Bridge and server in lockstep behind a link that the bridge simulates (bridge.link).
#include <cmath>
#include <vector>

#include "tests/support/catch.hpp"
#include "tests/system/stage.hpp"
#include "tests/system/trace.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

// 10 ms one way, 1 ms of jitter, and an overrun of up to 5 ms once a second at either side.
const std::string kBusy =
    "delay = 0.01\njitter = 0.001\nbridge_overruns = { every = 1, longest = 0.005 }\n"
    "server_overruns = { every = 1, longest = 0.005 }\n";

struct Run {
  Trace trace;
  double peak_shown = 0.0;     ///< [N]
  double impulse_shown = 0.0;  ///< [N s]
};

Run play(const Stage& stage, const std::string& link, const std::string& mode = "predict") {
  stage.write("bridge.toml", "[bridge]\nmode = \"" + mode + "\"\n[bridge.link]\n" + link +
                                 "[[device]]\ntype = \"virtual\"\nscript = \"script.csv\"\n"
                                 "hand = { mass = 0.12, damping = 2.0, stiffness = 300.0 }\n");
  const auto path = stage.path("trace.h5");
  std::filesystem::remove(path);
  Server server = stage.start_server({"--lockstep", "--record", path.string()});
  ChildProcess bridge = stage.start_bridge(server);
  REQUIRE(bridge.wait() == 0);
  REQUIRE(server.process.wait() == 0);
  CHECK_THAT(bridge.out(), ContainsSubstring("lockstep") && ContainsSubstring(" 0 gaps"));
  return {read_trace(path), number_after(bridge.out(), "peak force: "),
          number_after(bridge.out(), "impulse ")};
}

// Of the force on the object.
std::vector<double> forces(const Run& run) {
  const std::vector<double>& numbers = run.trace.numbers.at("/stylus/0/force");
  std::vector<double> magnitudes;
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    magnitudes.push_back(std::hypot(numbers[i], numbers[i + 1], numbers[i + 2]));
  }
  return magnitudes;
}

double peak(const Run& run) {
  const std::vector<double> all = forces(run);
  return *std::max_element(all.begin(), all.end());
}

double impulse(const Run& run) {
  double sum = 0.0;
  for (const double force : forces(run)) sum += force;
  return 0.002 * sum;
}

}  // namespace

TEST_CASE("simulated link: a run over a bad link is the same to the bit, and replayed so") {
  const Stage stage;
  const Run first = play(stage, kBusy + "loss = 0.05\nseed = 7\n");
  const FinishedProgram replay =
      run_to_end({IRDM_REPLAY, stage.path("trace.h5").string(), "--from", "inputs"});
  REQUIRE(replay.status == 0);
  CHECK_THAT(replay.out, ContainsSubstring("force 0 N") && ContainsSubstring("position 0 m"));
  const Run again = play(stage, kBusy + "loss = 0.05\nseed = 7\n");
  CHECK(first.trace.numbers == again.trace.numbers);
  CHECK(first.trace.contact == again.trace.contact);
  const Run other = play(stage, kBusy + "loss = 0.05\nseed = 8\n");
  CHECK(first.trace.numbers != other.trace.numbers);
}

TEST_CASE("simulated link: press, grab and swing feel over it as without it", "[unsanitized]") {
  const Stage stage;
  const Run near = play(stage, "");
  const Run far = play(stage, kBusy);
  REQUIRE(near.peak_shown > 0.3);
  for (const Run* run : {&near, &far}) {
    CHECK(run->peak_shown == Approx(near.peak_shown).epsilon(0.1));
    CHECK(peak(*run) == Approx(near.peak_shown).epsilon(0.1));
    CHECK(impulse(*run) == Approx(run->impulse_shown).epsilon(0.02));
  }
  const Run held = play(stage, kBusy, "hold");
  CHECK(held.peak_shown != Approx(near.peak_shown).epsilon(0.1));
}

TEST_CASE("simulated link: a process that was stopped gives the object no blow when it goes on",
          "[unsanitized]") {
  const Stage stage;
  const Run near = play(stage, "");
  for (const std::string side : {"bridge", "server"}) {
    CAPTURE(side);
    const Run run =
        play(stage, "delay = 0.002\n" + side + "_overruns = { pause_at = 1.0, pause = 0.3 }\n");
    CHECK(run.peak_shown > 0.3);
    // A hand that goes on against the force of before may come back far from what it holds.
    CHECK(run.peak_shown <= 3.3);  // bridge.max_force
    CHECK(peak(run) < 1.1 * near.peak_shown);
  }
}

TEST_CASE("simulated link: one that cannot carry the contact models gives no force at either end") {
  const Stage stage;
  const Run near = play(stage, "");
  const Run enough = play(stage, "bandwidth = 40e6\n");
  CHECK(enough.peak_shown == Approx(near.peak_shown).epsilon(0.1));
  CHECK(peak(enough) == Approx(near.peak_shown).epsilon(0.1));
  const Run narrow = play(stage, "bandwidth = 5e6\n");  // a model each step takes 16 Mbit/s
  CHECK(narrow.peak_shown == 0.0);
  CHECK(peak(narrow) == 0.0);
}

TEST_CASE("simulated link: a server in real time is not one for it") {
  const Stage stage;
  stage.write("bridge.toml", file_content(stage.path("bridge.toml")) + "[bridge.link]\n");
  const Server server = stage.start_server();
  ChildProcess bridge = stage.start_bridge(server);
  CHECK(bridge.wait() == 1);
  CHECK_THAT(bridge.err(),
             ContainsSubstring("bridge.link is simulated") && ContainsSubstring("--lockstep"));
}
