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
  std::uint64_t above = 0;
  std::uint64_t calm = 0;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const LyingLoop loop(seed);
    CAPTURE(loop.words);
    const LoopRun run = run_loop(loop.setup, LoopMode::kPredict, loop.link);
    CHECK(run.energy_from_nowhere <= 0.06);
    for (std::size_t hand = 0; hand < loop.honest; ++hand) {
      CHECK(run.peak_asked[hand] <= loop.setup.config.styluses[hand].max_force * (1 + 1e-9));
      CHECK(peak(run, hand) <= FilterLimits{}.max_force * (1 + 1e-9));
    }
    calm += loop.stalls ? 0 : 1;
    above += !loop.stalls && run.energy_from_nowhere > 0.02 ? 1 : 0;
    double& largest = most[loop.stalls ? 1 : 0];
    largest = std::max(largest, run.energy_from_nowhere);
  }
  // Not none: each of the account's allowances may be used, and what is lacking is forgiven.
  CHECK(20 * above <= calm);
  std::cout << count << " loops with lying peers: without stalls above 20 mJ that no hand did "
            << above << " of " << calm << ", at most " << most[0] << " J, with stalls " << most[1]
            << " J\n";
}

}  // namespace

TEST_CASE("lying peers: the world gets no more energy than hands give", "[slow]") {
  check_lies(50);
}

TEST_CASE("lying peers: the same two thousand times", "[exhaustive]") {
  check_lies(2000);
}
