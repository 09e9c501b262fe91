#include <catch2/catch.hpp>

#include "server/threads/force_thread.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

/// Lets every step run at once.
class NoClock final : public StepClock {
 public:
  bool wait(std::uint64_t) noexcept override { return !stopped(); }
};

}  // namespace

TEST_CASE("a reset that is asked for comes before the next step, once") {
  SimulationConfig config;
  config.gravity = Vector3(0, -9.81, 0);
  config.objects.resize(1);
  config.objects[0].model = std::make_shared<const Model>(synthetic_cube(2, 5, 10));
  Simulation simulation(config);
  StepRecord record;
  const StylusCommand nobody;
  for (int k = 0; k < 10; ++k) simulation.step({&nobody, 1}, record);
  const Vector3 fallen = record.object[0].position;

  NetworkServer network({});
  NoClock clock;
  StepSink sink(8);
  ForceThread force(simulation, network, clock, {&sink}, 5);
  force.request_reset();
  force.request_reset();  // until it is done, it is one
  force.start(RealTimeScheduling::kIgnore);
  REQUIRE(force.finished().wait(kDeadlineMs));
  force.finish();
  CHECK(force.report().steps == 5);
  CHECK(force.report().resets == 1);
  for (std::uint64_t k = 10; k < 15; ++k) {
    REQUIRE(sink.take(record));
    CHECK(record.force_step == k);
    CHECK(record.reset == (k == 10));
    CHECK(record.reset_step == 10);
    if (k == 10) CHECK(record.object[0].position.norm() < 0.1 * fallen.norm());
  }
}

TEST_CASE("the force thread tells how it fares while it runs, about once a second") {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = std::make_shared<const Model>(synthetic_cube(2, 5, 10));
  Simulation simulation(config);
  NetworkServer network({});
  RealTimeClock clock(0.002);
  ForceThread force(simulation, network, clock, {}, 0);
  force.request_reset();
  force.start(RealTimeScheduling::kIgnore);
  REQUIRE(eventually([&] { return force.health().receive(); }));
  const ForceHealth first = force.health().front();
  CHECK(first.steps > 0);
  CHECK(first.resets == 1);
  CHECK(first.step_time.count() == first.steps);
  CHECK(first.wakeup_delay.count() == first.steps - 1);  // the first one waits for nothing
  REQUIRE(eventually([&] { return force.health().receive(); }));
  const ForceHealth& second = force.health().front();
  CHECK(second.step_time.count() == second.steps - first.steps);  // of the last second alone
  force.finish();
}
