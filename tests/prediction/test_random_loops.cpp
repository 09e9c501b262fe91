#include <catch2/catch.hpp>

#include "tests/prediction/random_loop.hpp"

// A few of the loops of bench_closed_loops, which runs them by the thousand.

using namespace irdm::test;

TEST_CASE(
    "random loops: with the contact at the bridge none shakes, and the port gives no energy") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const RandomLoop loop(seed);
    CAPTURE(loop.words);
    const LoopRun direct = run_loop(loop.setup, LoopMode::kDirect);
    const LoopRun run = run_loop(loop.setup, LoopMode::kPredict, loop.link);
    CHECK(run.refused == 0);
    CHECK(run.lowest_energy[0] > -0.02);
    CHECK(unrest(run, 0.002).speed < std::max(0.02, 3.0 * unrest(direct, 0.002).speed));
  }
}
