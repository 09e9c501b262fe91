#include <algorithm>

#include "tests/prediction/delayed_loop.hpp"
#include "tests/prediction/dice.hpp"
#include "tests/support/catch.hpp"

// Steps of the server that take longer than dt, on a virtual clock: it falls behind, makes up for
// steps, and leaves some out.

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kServerDt = 0.002;  // [s]

// Two hands press a tethered cube from above and below and hold it.
LoopSetup two_hands(double server_step) {
  LoopSetup setup;
  setup.config.objects.resize(1);
  setup.config.objects[0].model = cube_of(1);
  setup.config.objects[0].friction = {1.0, 0.8};
  setup.config.objects[0].tether = {200.0, 5.0};
  setup.config.objects[0].damping = {5.0, 5.0};
  setup.config.styluses.assign(2, {0.0, 400.0, 0.0});
  for (const double side : {1.0, -1.0}) {
    setup.hands.push_back({{0.12, 10.0, 1000.0}, [side](double t) -> Vector3 {
                             const double depth = 0.015 * smooth(t, 0.2, 0.6);
                             return Vector3(0.003, side * (kHalfEdge + 0.004 - depth), 0.005);
                           }});
  }
  setup.steps = 1500;
  setup.filtered = true;
  setup.server_step = server_step;
  return setup;
}

struct Zeros {
  int touching = 0;  ///< steps
  int zero = 0;      ///< of them without any force
  int drops = 0;     ///< from more than half a newton to nothing within a step
};

Zeros zeros(const LoopRun& run, std::size_t hand) {
  Zeros found;
  for (std::size_t k = 1; k < run.touching[hand].size(); ++k) {
    if (!run.touching[hand][k]) continue;
    ++found.touching;
    if (!run.on_object[hand][k].isZero(0.0)) continue;
    ++found.zero;
    found.drops += run.on_object[hand][k - 1].norm() > 0.5 ? 1 : 0;
  }
  return found;
}

}  // namespace

TEST_CASE("slow server: object and hand get the same force though it is always behind") {
  const LoopRun direct = run_loop(two_hands(0.0), LoopMode::kPredict, {0.001});
  for (const double length : {0.9, 1.1, 1.3, 1.6}) {
    CAPTURE(length);
    const LoopRun run = run_loop(two_hands(length), LoopMode::kPredict, {0.001});
    for (std::size_t hand = 0; hand < 2; ++hand) {
      const Zeros found = zeros(run, hand);
      CAPTURE(hand, found.touching, found.zero, found.drops);
      CHECK(found.touching > 400);
      CHECK(found.zero < 10);
      CHECK(found.drops == 0);
      CHECK(peak(run, hand) == Approx(peak(direct, hand)).epsilon(0.2));
      // What the hand feels at the end of the run is what it feels without delay.
      CHECK(run.force[hand].back().norm() == Approx(direct.force[hand].back().norm()).epsilon(0.1));
    }
    CHECK(run.withheld == 0);
    CHECK(run.withheld_at_bridge == 0);
    CHECK(run.lost == 0);
  }
}

TEST_CASE(
    "slow server: a force that its models do not reach fades, and both sides count the steps") {
  const LoopRun run = run_loop(two_hands(3.0), LoopMode::kPredict, {0.001});
  double most = 0.0;
  for (std::size_t hand = 0; hand < 2; ++hand) {
    CHECK(zeros(run, hand).drops == 0);
    for (std::size_t k = 1; k < run.on_object[hand].size(); ++k) {
      const double fall = run.on_object[hand][k - 1].norm() - run.on_object[hand][k].norm();
      most = std::max(most, fall);
    }
  }
  CHECK(most < 1200.0 * kServerDt);  // the falling rate of the safety filter
  CHECK(run.withheld > 0);
  CHECK(run.withheld_at_bridge > 0);
}
