#include <cmath>

#include "device_bridge/commission/force_steps.hpp"
#include "tests/commission/step_rig.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::commission;
using namespace irdm::test;

TEST_CASE("commission: forces of a good device move the handle the way they point") {
  FaultyStylus device;
  StepRig rig(device);
  for (int axis = 0; axis < 3; ++axis) {
    ForceSignStep step(axis);
    const Judgement judgement = rig.run(step);
    INFO(judgement.words);
    CHECK(judgement.passed);
  }
  CHECK(rig.loop.peak_force() < 1.01 * ForceSignStep::kForce);
}

TEST_CASE("commission: a reversed force and swapped forces fail with words of their own") {
  FaultyStylus device;
  StepRig rig(device);
  device.force_axes = reversed(2);
  ForceSignStep towards(2);
  const Judgement turned = rig.run(towards);
  CHECK_FALSE(turned.passed);
  CHECK_THAT(turned.words, ContainsSubstring("along +z moved the handle along -z") &&
                               ContainsSubstring("the force is reversed"));
  device.force_axes = swapped(0, 1);
  ForceSignStep right(0);
  const Judgement exchanged = rig.run(right);
  CHECK_FALSE(exchanged.passed);
  CHECK_THAT(exchanged.words, ContainsSubstring("forces are swapped"));
}

TEST_CASE("commission: a hand that drifts neither hides a force nor stands for one") {
  FaultyStylus device;
  StepRig rig(device);
  device.drift = [](double time) { return Vector3(1e-3 * time, -2e-3 * time, 0.0); };
  ForceSignStep good(0);
  CHECK(rig.run(good).passed);
  device.force_axes = reversed(0);
  ForceSignStep turned(0);
  CHECK_THAT(rig.run(turned).words, ContainsSubstring("the force is reversed"));
  device.force_axes.setZero();
  for (int k = 0; k < 12; ++k) {
    device.drift = [k](double time) {
      const double phase = 0.5 * k;
      return Vector3(3e-3 * std::sin(2.0 * time + phase), 2e-3 * std::sin(1.3 * time + phase),
                     1e-3 * std::sin(3.0 * time - phase));
    };
    ForceSignStep off(0);
    const Judgement judgement = rig.run(off);
    CAPTURE(k, judgement.words);
    CHECK_FALSE(judgement.passed);
  }
}

TEST_CASE("commission: motors that are off, and a device that is not ready, fail at the force") {
  FaultyStylus device;
  StepRig rig(device);
  device.force_axes.setZero();
  ForceSignStep off(0);
  CHECK_THAT(rig.run(off).words, ContainsSubstring("did not move the handle"));
  device.ready = false;
  ForceSignStep not_ready(1);
  CHECK_THAT(rig.run(not_ready).words, ContainsSubstring("the device is not ready"));
  RampStep ramp(3.3);
  CHECK_FALSE(rig.run(ramp).passed);
}

TEST_CASE("commission: the ramp reaches its limit slowly, and a weaker filter is told") {
  FaultyStylus device;
  StepRig rig(device);
  RampStep step(3.3);
  rig.runner.begin(step);
  double before = 0.0;
  double steepest = 0.0;
  while (!rig.runner.ended().consume()) {
    rig.tick();
    steepest = std::max(steepest, rig.loop.shown().norm() - before);
    before = rig.loop.shown().norm();
  }
  CHECK(step.judge(rig.measured).passed);
  CHECK(rig.measured.max_force.value() == Approx(3.3).epsilon(0.02));
  CHECK(steepest < 2e-3);  // N a tick
  FaultyStylus weak;
  StepRig limited(weak, {.max_force = 1.0});
  RampStep more(3.3);
  const Judgement judgement = limited.run(more);
  CHECK_FALSE(judgement.passed);
  CHECK_THAT(judgement.words, ContainsSubstring("1 N of 3.3 N"));
}

TEST_CASE("commission: a handle that runs away ends the ramp") {
  FaultyStylus device;
  StepRig rig(device);
  device.reading_axes *= 20.0;
  RampStep step(3.3);
  const Judgement judgement = rig.run(step);
  CHECK_FALSE(judgement.passed);
  CHECK_THAT(judgement.words, ContainsSubstring("the handle moved away by 10 cm"));
  CHECK(rig.loop.peak_force() < 2.0);
}

TEST_CASE("commission: a clutch button, a lost server and a lost device take the force at once") {
  FaultyStylus device;
  StepRig rig(device);
  StopStep button(StopStep::Event::kButton, 1);
  CHECK(rig.run(button).passed);
  CHECK(rig.measured.stop_button.value() < 0.06);
  StopStep link(StopStep::Event::kLink, 1);
  device.ask({});
  CHECK(rig.run(link).passed);
  CHECK(rig.measured.stop_link.value() <= 0.031);
  StopStep cable(StopStep::Event::kCable, 1);
  rig.runner.begin(cable);
  for (int i = 0; !rig.runner.ended().consume(); ++i) {
    device.unplugged = i > 2500;
    rig.tick();
  }
  CHECK(cable.judge(rig.measured).passed);
  CHECK(rig.measured.stop_cable.value() < 0.03);
}

TEST_CASE("commission: an emergency stop that nobody makes is told, and a button of the device") {
  FaultyStylus device;
  StepRig rig(device);
  StopStep nobody(StopStep::Event::kButton, -1);
  const Judgement judgement = rig.run(nobody);
  CHECK_FALSE(judgement.passed);
  CHECK_THAT(judgement.words, ContainsSubstring("nothing happened within 60 s"));
  StopStep own(StopStep::Event::kButton, -1);
  rig.runner.begin(own);
  for (int i = 0; !rig.runner.ended().consume(); ++i) {
    device.ready = i < 2500;
    rig.tick();
  }
  CHECK(own.judge(rig.measured).passed);
}
