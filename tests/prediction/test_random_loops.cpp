#include "tests/prediction/random_loop.hpp"
#include "tests/support/catch.hpp"

// A few of the loops of bench_closed_loops, which runs them by the thousand.

using namespace irdm::test;

namespace {

bool shakes(const LoopRun& run, const RandomLoop& loop) {
  const LoopRun direct = run_loop(loop.setup, LoopMode::kDirect);
  return !(unrest(run, 0.002).speed < std::max(0.02, 3.0 * unrest(direct, 0.002).speed));
}

}  // namespace

TEST_CASE("random loops: with the contact at the bridge none shakes, and the port gives no energy",
          "[slow]") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomLoop loop(seed);
    CAPTURE(loop.words);
    const LoopRun run = run_loop(loop.setup, LoopMode::kPredict, loop.link);
    CHECK(run.refused == 0);
    CHECK(run.lowest_energy[0] > -0.02);
    CHECK(run.lowest_gain[0] == 1.0);
    CHECK_FALSE(shakes(run, loop));
  }
}

// Younger forces are not watched, see OscillationDetector. Without it a third of these hands shake;
// with it some in a thousand, and which ones rounding decides, so two of all are let pass.
TEST_CASE("random loops: forces that are held over a delay hardly ever shake a hand for long",
          "[slow]") {
  constexpr double kWatched = 0.002;  // one way [s]
  int shaking = 0;
  int of_much_energy = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomLoop loop(seed);
    CAPTURE(loop.words);
    const LoopRun run = run_loop(loop.setup, LoopMode::kHold, loop.link);
    if (!(run.lowest_energy[0] > -0.02)) ++of_much_energy;
    if (loop.link.delay > kWatched && shakes(run, loop)) ++shaking;
  }
  CHECK(shaking <= 2);
  CHECK(of_much_energy <= 1);
}

// Of 10 000 loops the three in which cycles alone do not show what the port gives: those of 3253
// and 9715 are slower than what is watched of a force of 4 ms (a bounce ten times a second), and in
// 5318 each half of a cycle gives, so that the energy has no lows.
TEST_CASE("random loops: a held force that gives energy in any course is lowered") {
  for (const std::uint64_t seed : {3253, 5318, 9715}) {
    const RandomLoop loop(seed);
    CAPTURE(loop.words);
    const LoopRun run = run_loop(loop.setup, LoopMode::kHold, loop.link);
    CHECK(run.lowest_gain[0] < 1.0);
    CHECK(run.lowest_energy[0] > -0.02);
    CHECK_FALSE(shakes(run, loop));
  }
}

TEST_CASE("random loops: near the server taps, presses and swings are shown in full", "[slow]") {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const RandomLoop loop(seed, true);
    CAPTURE(loop.words);
    const LoopRun run = run_loop(loop.setup, LoopMode::kHold, loop.link);
    CHECK(run.lowest_gain[0] == 1.0);
    CHECK(run.lowest_energy[0] > -1e-3);
  }
}
