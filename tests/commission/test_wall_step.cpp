#include "device_bridge/commission/wall_step.hpp"
#include "tests/commission/step_rig.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::commission;
using namespace irdm::test;

TEST_CASE("commission: the wall ends where the filter acts, and half of it is proposed") {
  FaultyStylus device;
  StepRig rig(device);
  WallStep step;
  const Judgement judgement = rig.run(step);
  INFO(judgement.words);
  CHECK(judgement.passed);
  CHECK(rig.measured.coupling_stiffness.value() ==
        Approx(0.5 * rig.measured.wall_stiffness.value()));
  CHECK(rig.measured.wall_stiffness.value() >= 300.0);
}

TEST_CASE("commission: a slower loop bears a softer wall") {
  const auto stiffest = [](std::int64_t period_ns) {
    FaultyStylus device;
    StepRig rig(device);
    rig.period_ns = period_ns;
    WallStep step;
    rig.run(step);
    return rig.measured.wall_stiffness.value_or(0.0);
  };
  CHECK(stiffest(6 * kMs) < stiffest(kMs));
}

TEST_CASE("commission: a wall that is not pressed fails") {
  FaultyStylus device;
  StepRig rig(device);
  WallStep step;
  device.ask({});
  rig.runner.begin(step);
  while (!rig.runner.ended().consume()) rig.tick();
  const Judgement judgement = step.judge(rig.measured);
  CHECK_FALSE(judgement.passed);
  CHECK_THAT(judgement.words, ContainsSubstring("the wall was not pressed"));
  CHECK_FALSE(rig.measured.coupling_stiffness.has_value());
}
