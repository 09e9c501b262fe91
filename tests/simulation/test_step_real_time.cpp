#include <cmath>

#include "simulation/step/simulation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/real_time_guard.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kStepsOfEach = 250'000;  // of each engine with one and two styluses: a million

}  // namespace

TEST_CASE("a million force steps touch neither heap, locks, exceptions nor files", "[slow]") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  const ResponseKind kind = GENERATE(ResponseKind::kModal, ResponseKind::kDense);
  const std::size_t styluses = GENERATE(1, 2);
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fem_cube({2, 2000.0, 8.0, 0.002, 100}, kind);
  config.objects[0].friction = {0.6, 0.5};
  config.objects[0].damping = {2.0, 2.0};
  config.objects[0].tether = {200.0, 1.0};
  config.styluses.assign(styluses, {0.0, 1000.0, 0.01});
  Simulation simulation(config);
  StepRecord record;
  ContactModel model;
  std::uint64_t touching = 0;
  std::uint64_t held = 0;
  std::uint64_t predicted = 0;
  std::uint64_t late = 0;
  const RealTimeGuard guard;
  for (int k = 0; k < kStepsOfEach; ++k) {
    const double t = 0.002 * (k % 2000);
    const double depth = 0.004 * std::sin(12.0 * t);
    std::array<StylusCommand, 2> commands{
        StylusCommand{k % 2000 > 0,
                      k % 2000 < 1000 ? kGrabButton : 0u,
                      Vector3(0.001, 0.061 - depth, 0.0),
                      {}},
        StylusCommand{k % 500 < 400, 0u, Vector3(0.061 - depth, 0.01, 0.002), {}}};
    // Every now and then what a bridge decided, and what it says too late.
    const AppliedForce bridged{Vector3(0, -0.1, 0), commands[0].tip, Vector3(0, 0.06, 0)};
    if (k % 100 >= 98) commands[0].bridged = BridgedForce{bridged.force, bridged.arm, 0};
    if (k % 100 == 99) late += simulation.insert_delayed_force(0, bridged, 1) ? 1 : 0;
    simulation.step({commands.data(), styluses}, record, k % 2000 == 1999);
    if (k % 10 == 0) {
      simulation.predict_horizon(0, commands[0].tip, kMaxHorizon, model);
      predicted += model.valid ? 1 : 0;
    }
    for (std::size_t s = 0; s < styluses; ++s) {
      touching += record.stylus[s].contact == ContactState::kTouching ? 1 : 0;
      held += record.stylus[s].contact == ContactState::kHeld ? 1 : 0;
    }
  }
  const std::string violations = guard.violations();
  INFO(violations);
  CHECK(violations.empty());
  CHECK(late > kStepsOfEach / 200);
  CHECK(touching > kStepsOfEach / 20);
  CHECK(held > kStepsOfEach / 3);
  CHECK(predicted > kStepsOfEach / 20);
}
