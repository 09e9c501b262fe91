#include "device_bridge/commission/force_steps.hpp"
#include "device_bridge/commission/plan.hpp"
#include "tests/commission/step_rig.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::commission;
using namespace irdm::test;

TEST_CASE("commission: a step that is stopped loses its force smoothly within 30 ms") {
  FaultyStylus device;
  StepRig rig(device);
  RampStep step(3.3);
  rig.runner.begin(step);
  for (int i = 0; i < 3000; ++i) rig.tick();
  const double felt = rig.loop.shown().norm();
  CHECK(felt > 2.0);
  rig.runner.stop();
  double before = felt;
  for (int i = 0; i < 32; ++i) {
    rig.tick();
    CHECK(before - rig.loop.shown().norm() < 0.1 * felt);
    before = rig.loop.shown().norm();
  }
  CHECK(before == 0.0);
  CHECK(rig.runner.ended().consume());
}

TEST_CASE("commission: the next step begins at no force, and without the last one's") {
  FaultyStylus device;
  StepRig rig(device);
  RampStep first(3.3);
  rig.runner.begin(first);
  for (int i = 0; i < 3000; ++i) rig.tick();
  rig.runner.stop();
  for (int i = 0; i < 100; ++i) rig.tick();
  RampStep second(3.3);
  rig.runner.begin(second);
  for (int i = 0; i < 100; ++i) rig.tick();
  CHECK(rig.loop.shown().norm() < 0.1);
}

TEST_CASE("commission: no step allocates in the servo loop") {
  for (const auto& step : make_plan({})) {
    CAPTURE(step->name());
    FaultyStylus device;
    StepRig rig(device);
    device.ask(step->request().order);
    rig.runner.begin(*step);
    rig.tick();
    const AllocationGuard guard;
    for (int i = 0; i < 6000; ++i) rig.tick();
    if (AllocationGuard::active()) CHECK(guard.count() == 0);
  }
}

TEST_CASE("commission: the plan has no buttons that are not there, and no cable of a virtual one") {
  const auto names = [](const PlanSettings& settings) {
    std::string all;
    for (const auto& step : make_plan(settings)) all += step->name() + ", ";
    return all;
  };
  CHECK(names({}) ==
        "axis right, axis up, axis towards you, button grab, button clutch, button reset, "
        "rest noise, loop rate, force right, force up, force towards you, ramp, stop by button, "
        "stop without server, wall, stop by cable, ");
  const std::string few =
      names({.buttons = {.grab = 0, .clutch = -1, .reset = -1}, .simulated = true});
  CHECK(few.find("button clutch") == std::string::npos);
  CHECK(few.find("cable") == std::string::npos);
}
