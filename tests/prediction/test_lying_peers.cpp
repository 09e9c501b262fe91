#include <algorithm>
#include <array>
#include <iostream>

#include "device_bridge/safety/safety_filter.hpp"
#include "simulation/step/bridged_stylus.hpp"
#include "tests/prediction/lying_loop.hpp"
#include "tests/support/catch.hpp"

// Peers that lie or pump: the world gets hardly more energy than hands gave, and an honest hand no
// more force than its device shows.

using namespace irdm;
using namespace irdm::test;

namespace {

void check_lies(std::uint64_t count) {
  std::array<double, 2> most{};
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const LyingLoop loop(seed);
    CAPTURE(loop.words);
    const LoopRun run = run_loop(loop.setup, LoopMode::kPredict, loop.link);
    CHECK(run.energy_from_nowhere <= (loop.stalls ? 0.06 : 0.02));
    for (std::size_t hand = 0; hand < loop.honest; ++hand) {
      CHECK(run.peak_asked[hand] <= loop.setup.config.styluses[hand].max_force * (1 + 1e-9));
      CHECK(peak(run, hand) <= FilterLimits{}.max_force * (1 + 1e-9));
    }
    double& above = most[loop.stalls ? 1 : 0];
    above = std::max(above, run.energy_from_nowhere);
  }
  std::cout << count << " loops with lying peers: at most " << most[0] << " J that no hand did, "
            << most[1] << " J with stalls\n";
}

}  // namespace

TEST_CASE("lying peers: the world gets no more energy than hands give") {
  check_lies(50);
}

TEST_CASE("lying peers: the same two thousand times", "[exhaustive]") {
  check_lies(2000);
}
