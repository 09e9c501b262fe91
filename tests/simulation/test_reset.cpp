// Everything is reset.
#include <cmath>
#include <vector>

#include "simulation/deformation/deformation.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/simulation/two_on_floor.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kTop = 0.06;

using Commands = std::array<StylusCommand, 2>;

StylusCommand at(double x, double y, std::uint32_t buttons = 0) {
  return {true, buttons, Vector3(x, y, 0.003), std::nullopt};
}

// Both styluses come down on their cubes from above, the second takes hold.
Commands press(int k) {
  const double y = kTop + 0.01 - 2e-4 * std::min(k, 100);
  return {at(0.01, y), at(0.31, y, k > 80 ? kGrabButton : 0u)};
}

void check_same(const StepRecord& a, const StepRecord& b) {
  for (std::size_t i = 0; i < 2; ++i) {
    REQUIRE(a.object[i].position == b.object[i].position);
    REQUIRE(a.object[i].orientation.coeffs() == b.object[i].orientation.coeffs());
    REQUIRE(a.object[i].velocity == b.object[i].velocity);
    REQUIRE(a.object[i].floor_force == b.object[i].floor_force);
    REQUIRE(a.stylus[i].force == b.stylus[i].force);
    REQUIRE(a.stylus[i].proxy == b.stylus[i].proxy);
    REQUIRE(a.stylus[i].contact == b.stylus[i].contact);
  }
}

StepRecord step(Simulation& simulation, const Commands& commands, bool reset = false) {
  StepRecord record;
  simulation.step(commands, record, reset);
  return record;
}

}  // namespace

TEST_CASE("reset: what follows is, to the bit, what follows a start", "[unsanitized]") {
  const ResponseKind kind = GENERATE(ResponseKind::kModal, ResponseKind::kDense);
  Simulation fresh(two_on_floor(kind));
  Simulation used(two_on_floor(kind));
  bool touched = false;
  for (int k = 0; k < 200; ++k) {
    const StepRecord record = step(used, press(k));
    touched = touched || record.stylus[0].force.norm() > 0.05;
  }
  REQUIRE(touched);
  StepRecord reset;
  SECTION("by the reset button of a stylus") {
    Commands pressed = press(0);
    pressed[1].buttons = kResetButton;
    reset = step(used, pressed);
  }
  SECTION("asked for from outside") {
    reset = step(used, press(0), true);
  }
  CHECK(reset.reset);
  CHECK(reset.force_step == 200);
  CHECK(reset.reset_step == 200);
  check_same(reset, step(fresh, press(0)));
  for (int k = 1; k < 200; ++k) {
    const StepRecord record = step(used, press(k));
    check_same(record, step(fresh, press(k)));
    REQUIRE_FALSE(record.reset);
    REQUIRE(record.reset_step == 200);
    REQUIRE(record.force_step == 200u + static_cast<unsigned>(k));
  }
}

TEST_CASE("reset: only a button that goes down resets, once") {
  Simulation simulation(two_on_floor());
  const auto resets = [&](std::uint32_t first, std::uint32_t second, bool present = true) {
    Commands commands{at(0.0, 0.2, first), at(0.3, 0.2, second)};
    commands[1].present = present;
    return step(simulation, commands).reset;
  };
  CHECK_FALSE(resets(kResetButton, 0));  // down from the start
  CHECK_FALSE(resets(0, 0));
  CHECK(resets(kResetButton, 0));
  CHECK_FALSE(resets(kResetButton, 0));
  CHECK(resets(kResetButton, kResetButton));
  CHECK_FALSE(resets(0, kGrabButton));
  CHECK(resets(0, kResetButton | kGrabButton));
  CHECK_FALSE(resets(0, kResetButton, false));
  CHECK_FALSE(resets(0, kResetButton));  // it was down when its stylus came back
  CHECK_FALSE(resets(0, 0));
  CHECK(resets(kResetButton, kResetButton));
}

TEST_CASE("reset: a tip inside has to come from outside to touch") {
  Simulation simulation(two_on_floor());
  StepRecord record;
  for (int k = 0; k < 120; ++k) record = step(simulation, press(k));
  REQUIRE(record.stylus[0].contact == ContactState::kTouching);
  REQUIRE(record.stylus[1].contact == ContactState::kHeld);
  // The tips stay where they are, a centimetre inside; the second keeps its button down.
  const Commands inside{at(0.01, kTop - 0.01), at(0.31, kTop - 0.003, kGrabButton)};
  for (int k = 0; k < 20; ++k) {
    record = step(simulation, inside, k == 0);
    REQUIRE(record.stylus[0].contact == ContactState::kFree);
    REQUIRE(record.stylus[1].contact == ContactState::kFree);
  }
  // Within reach, a button that goes up and down again takes hold.
  step(simulation, {at(0.01, kTop + 0.02), at(0.31, kTop - 0.003)});
  record = step(simulation, {at(0.01, kTop - 0.01), at(0.31, kTop - 0.003, kGrabButton)});
  CHECK(record.stylus[0].contact == ContactState::kTouching);
  CHECK(record.stylus[1].contact == ContactState::kHeld);
}

TEST_CASE("reset: the deformed surface follows") {
  const SimulationConfig config = two_on_floor();
  Simulation simulation(config);
  Deformation whole(config);
  Deformation holed(config);
  constexpr int kReset = 130;
  for (int k = 0; k < 200; ++k) {
    // Afterwards nothing touches: all that is left of the pressing would show.
    const StepRecord record =
        step(simulation, k < kReset ? press(k) : Commands{at(0.0, 0.2), at(0.3, 0.2)}, k == kReset);
    whole.follow(record);
    // The step of the reset itself is among those that are lost.
    if (k < kReset - 5 || k > kReset + 5) holed.follow(record);
    if (k != kReset) continue;
    SurfaceFrame frame = rest_frame(config);
    whole.compute(frame);
    CHECK(frame.objects[0].displacement.isZero(0.0));
  }
  CHECK(holed.lost_steps() == 11);
  for (int i = 0; i < 2; ++i) {
    Points u;
    simulation.object(i).engine().displacement(u);
    SurfaceFrame frame = rest_frame(config);
    whole.compute(frame);
    CHECK(frame.objects[static_cast<std::size_t>(i)].displacement == u);
    holed.compute(frame);
    CHECK(frame.objects[static_cast<std::size_t>(i)].displacement == u);
  }
}
