#include "device_bridge/commission/reading_steps.hpp"
#include "tests/commission/step_rig.hpp"
#include "tests/support/catch.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::commission;
using namespace irdm::test;

TEST_CASE("commission: axes of a good device have the right signs") {
  FaultyStylus device;
  StepRig rig(device);
  for (int axis = 0; axis < 3; ++axis) {
    AxisStep step(axis);
    const Judgement judgement = rig.run(step);
    CHECK(judgement.passed);
    CHECK_THAT(judgement.words, ContainsSubstring(std::string("is +") + "xyz"[axis]));
  }
}

TEST_CASE("commission: swapped axes and a wrong sign are told apart") {
  FaultyStylus device;
  StepRig rig(device);
  device.reading_axes = swapped(0, 2);
  AxisStep right(0);
  const Judgement exchanged = rig.run(right);
  CHECK_FALSE(exchanged.passed);
  CHECK_THAT(exchanged.words, ContainsSubstring("right is +z, not +x: axes are swapped"));
  device.reading_axes = reversed(1);
  AxisStep up(1);
  const Judgement wrong = rig.run(up);
  CHECK_FALSE(wrong.passed);
  CHECK_THAT(wrong.words, ContainsSubstring("up is -y, not +y: the sign is wrong"));
}

TEST_CASE("commission: a handle that is not moved, or askew, has no clear axis") {
  FaultyStylus device;
  StepRig rig(device);
  device.reading_axes.setZero();
  AxisStep still(0);
  const Judgement none = rig.run(still);
  CHECK_FALSE(none.passed);
  CHECK_THAT(none.words, ContainsSubstring("no clear movement"));
  device.reading_axes = Matrix3::Ones();
  AxisStep askew(0);
  CHECK_FALSE(rig.run(askew).passed);
}

TEST_CASE("commission: a button has the bit of its function, or the words say which") {
  FaultyStylus device;
  StepRig rig(device);
  ButtonStep grab("grab", 0);
  CHECK(rig.run(grab).passed);
  device.button_shift = 2;
  ButtonStep shifted("grab", 0);
  const Judgement other = rig.run(shifted);
  CHECK_FALSE(other.passed);
  CHECK_THAT(other.words, ContainsSubstring("bit 2 changed, not 0; set buttons.grab = 2"));
  device.button_shift = 31;
  ButtonStep nothing("clutch", 1);
  const Judgement none = rig.run(nothing);
  CHECK_FALSE(none.passed);
  CHECK_THAT(none.words, ContainsSubstring("no button was seen"));
}

TEST_CASE("commission: noise at rest is measured as it is") {
  FaultyStylus device({.noise = 2e-5});
  StepRig rig(device);
  RestStep step;
  CHECK(rig.run(step).passed);
  CHECK(rig.measured.position_noise.value() == Approx(2e-5).epsilon(0.1));
  CHECK(rig.measured.velocity_noise.value() == Approx(2e-5 * std::sqrt(2.0) / 1e-3).epsilon(0.1));
}

TEST_CASE("commission: a noisy encoder fails at rest, and a handle that moves does") {
  FaultyStylus noisy({.noise = 3e-4});
  StepRig rig(noisy);
  RestStep step;
  const Judgement judgement = rig.run(step);
  CHECK_FALSE(judgement.passed);
  CHECK_THAT(judgement.words, ContainsSubstring("the encoder is noisy"));
  FaultyStylus moving;
  StepRig moved(moving);
  AxisStep axis(0);
  moving.ask(axis.request().order);
  RestStep rest;
  moved.runner.begin(rest);
  for (int i = 0; i < 2100; ++i) moved.tick();
  const Judgement drift = rest.judge(moved.measured);
  CHECK_FALSE(drift.passed);
  CHECK_THAT(drift.words, ContainsSubstring("let it rest"));
}

TEST_CASE("commission: readings of no use fail at rest") {
  FaultyStylus device;
  StepRig rig(device);
  device.unplugged = true;
  RestStep step;
  const Judgement judgement = rig.run(step);
  CHECK_FALSE(judgement.passed);
  CHECK_THAT(judgement.words, ContainsSubstring("only 0 readings"));
}

TEST_CASE("commission: rate and jitter are those of the loop") {
  FaultyStylus device;
  StepRig rig(device);
  RateStep step(1000.0);
  CHECK(rig.run(step).passed);
  CHECK(rig.measured.rate.value() == Approx(1000.0));
  CHECK(rig.measured.jitter.value() < 1e-6);
  CHECK(rig.measured.readings.value() == Approx(1000.0).epsilon(0.01));
}

TEST_CASE("commission: a slow loop and a device with few readings fail at the rate") {
  FaultyStylus device;
  StepRig rig(device);
  rig.period_ns = 3 * kMs;
  RateStep slow(1000.0);
  const Judgement loop = rig.run(slow);
  CHECK_FALSE(loop.passed);
  CHECK_THAT(loop.words,
             ContainsSubstring("333.3 Hz") && ContainsSubstring("the loop is too slow"));
  rig.period_ns = kMs;
  device.repeats_every = 4;
  RateStep repeats(1000.0);
  const Judgement readings = rig.run(repeats);
  CHECK_FALSE(readings.passed);
  CHECK_THAT(readings.words, ContainsSubstring("the device is too slow"));
}

TEST_CASE("commission: a loop of the right rate whose ticks come late fails by its jitter") {
  FaultyStylus device;
  StepRig rig(device);
  RateStep step(1000.0);
  rig.runner.begin(step);
  for (int i = 0; !rig.runner.ended().consume(); ++i) {
    rig.period_ns = i % 10 == 0 ? 5 * kMs : kMs * 5 / 9;
    rig.tick();
  }
  const Judgement judgement = step.judge(rig.measured);
  CHECK_FALSE(judgement.passed);
  CHECK_THAT(judgement.words, ContainsSubstring("a whole period too late"));
}
