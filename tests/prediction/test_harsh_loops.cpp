#include <algorithm>
#include <iostream>

#include "tests/prediction/harsh_loop.hpp"
#include "tests/support/catch.hpp"

// Whatever link and machines do, the object gets no blow: no more than a device can show, and
// hardly more energy than hands gave.

using namespace irdm;
using namespace irdm::test;

namespace {

void check_loops(std::uint64_t count) {
  int shown = 0;
  int above = 0;
  double most = 0.0;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    const HarshLoop loop(seed);
    CAPTURE(loop.words);
    const LoopRun run = run_loop(loop.setup, LoopMode::kPredict, loop.link);
    CHECK(run.refused == 0);
    CHECK(run.peak_on_object <= FilterLimits{}.max_force * (1 + 1e-9));
    if (peak(run) > 0.0) ++shown;
    if (run.energy_from_nowhere > 0.02) ++above;
    most = std::max(most, run.energy_from_nowhere);
  }
  CHECK(static_cast<std::uint64_t>(2 * shown) > count);
  // Not none: the floor is frozen in contact models, and so are all but one of the other hands; and
  // a device whose bridge overruns by 20 ms goes on giving its hand what it shows.
  CHECK(static_cast<std::uint64_t>(10 * above) < count);
  CHECK(most < 0.08);
  std::cout << count << " harsh loops: above 20 mJ that no hand did " << above << ", at most "
            << most << " J\n";
}

}  // namespace

TEST_CASE("harsh loops: no more force than a device shows, hardly more energy than hands give",
          "[slow]") {
  check_loops(200);
}

TEST_CASE("harsh loops: the same two thousand times", "[exhaustive]") {
  check_loops(2000);
}
