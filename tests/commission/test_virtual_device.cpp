#include <functional>

#include "tests/commission/played_plan.hpp"
#include "tests/commission/step_rig.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::StartsWith;
using namespace irdm;
using namespace irdm::commission;
using namespace irdm::test;

namespace {

/// A virtual device as good as a Touch, with a flaw.
Report commission_virtual(const std::function<void(FaultyStylus&, StepRig&)>& spoil = {},
                          const SensorParameters& sensor = {.resolution = 5.5e-5, .noise = 1e-5}) {
  FaultyStylus device(sensor);
  StepRig rig(device);
  if (spoil) spoil(device, rig);
  Report report = play_plan(
      {.simulated = true}, rig.runner, [&](const Order& order) { device.ask(order); },
      [&] { rig.tick(); });
  report.type = "virtual";
  report.device = device.identity();
  return report;
}

}  // namespace

TEST_CASE("commission: the virtual device passes all steps, and its report is the example") {
  const Report report = commission_virtual();
  INFO(to_text(report));
  CHECK(report.signed_off());
  CHECK(report.measured.coupling_stiffness.has_value());
  check_example(report, "commission-virtual.toml");
}

TEST_CASE("commission: a flaw of a device fails at the right step, and no force comes after it") {
  const auto failed = [](const std::function<void(FaultyStylus&, StepRig&)>& spoil) {
    const Report report = commission_virtual(spoil);
    CHECK_FALSE(report.signed_off());
    return last_step(report);
  };
  CHECK_THAT(failed([](FaultyStylus& device, StepRig&) { device.reading_axes = swapped(0, 1); }),
             StartsWith("axis right: right is +y, not +x: axes are swapped"));
  CHECK_THAT(failed([](FaultyStylus& device, StepRig&) { device.reading_axes = reversed(2); }),
             StartsWith("axis towards you: towards you is -z, not +z: the sign is wrong"));
  CHECK_THAT(failed([](FaultyStylus& device, StepRig&) { device.button_shift = 1; }),
             StartsWith("button grab: bit 1 changed, not 0"));
  CHECK_THAT(failed([](FaultyStylus&, StepRig& rig) { rig.period_ns = 2 * kMs; }),
             StartsWith("loop rate: 500 Hz"));
  CHECK_THAT(failed([](FaultyStylus& device, StepRig&) { device.force_axes = reversed(1); }),
             StartsWith("force up: a force along +y moved the handle along -y"));
  const Report noisy = commission_virtual({}, {.noise = 2e-4});
  CHECK_THAT(last_step(noisy), StartsWith("rest noise: position 0.199"));
}
