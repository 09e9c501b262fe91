#include <algorithm>
#include <array>
#include <cmath>

#include "tests/prediction/delayed_loop.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"

// Transparency of the contact that is solved at the bridge: the force on the hand with a link in
// between, against the same loop without.

using namespace irdm;
using test::FemCube;
using test::largest_error;
using test::LoopHand;
using test::LoopLink;
using test::LoopMode;
using test::LoopRun;
using test::LoopSetup;
using test::run_loop;

namespace {

constexpr double kPredictedHalf = 0.06;

LoopSetup cube(double youngs_modulus, ResponseKind kind = ResponseKind::kModal) {
  LoopSetup setup;
  setup.config.objects.resize(1);
  setup.config.objects[0].model = test::fem_cube({.youngs_modulus = youngs_modulus}, kind);
  setup.config.objects[0].friction = {0.6, 0.5};
  setup.config.styluses = {{0.0, 2000.0, 0.005}};
  return setup;
}

double smooth(double t, double from, double to) {
  const double s = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

// Held at a point and swung a way to either side at 1.5 Hz [m], the start made smooth.
LoopHand swinging(const Vector3& at, double way = 0.05) {
  return {.target =
              [at, way](double t) {
                const double sway =
                    way * smooth(t, 0.1, 0.4) * std::sin(2 * M_PI * 1.5 * (t - 0.1));
                return Vector3(at + Vector3(sway, 0, 0));
              },
          .grab = true};
}

LoopSetup swung(double youngs_modulus, ResponseKind kind = ResponseKind::kModal,
                double way = 0.05) {
  LoopSetup setup = cube(youngs_modulus, kind);
  setup.hands.push_back(swinging({0, kPredictedHalf, 0}, way));
  return setup;
}

// A cube at home by its tether, pressed from above; then the hand wants to go aside, so far that
// the tip slips, and away again.
LoopSetup pressed(double youngs_modulus, double aside) {
  LoopSetup setup = cube(youngs_modulus);
  setup.config.objects[0].tether = {1000.0, 10.0};
  setup.config.objects[0].damping = {20.0, 20.0};
  setup.hands.push_back({.target = [aside](double t) {
    const double down = 0.02 * (smooth(t, 0.1, 0.6) - smooth(t, 2.2, 2.6));
    return Vector3(aside * smooth(t, 0.8, 2.0), kPredictedHalf + 0.005 - down, 0.01);
  }});
  return setup;
}

// The same cube, tapped from above: the tip comes with some 0.3 m/s and stays for 60 ms.
LoopSetup tapped(double youngs_modulus) {
  LoopSetup setup = cube(youngs_modulus);
  setup.config.objects[0].tether = {1000.0, 10.0};
  setup.config.objects[0].damping = {20.0, 20.0};
  setup.hands.push_back({.target = [](double t) {
    const double in = std::fmod(t, 0.8);
    const double down = 0.03 * (smooth(in, 0.2, 0.3) - smooth(in, 0.36, 0.5));
    return Vector3(0, kPredictedHalf + 0.015 - down, 0.01);
  }});
  return setup;
}

// Held at two opposite sides; one hand swings, the other follows.
LoopSetup by_two(double youngs_modulus) {
  LoopSetup setup = cube(youngs_modulus);
  setup.config.styluses = {{0.0, 2000.0, 0.005}, {0.0, 2000.0, 0.005}};
  setup.hands.push_back(swinging({-kPredictedHalf, 0, 0}));
  setup.hands.push_back(
      {.target = [](double) { return Vector3(kPredictedHalf, 0, 0); }, .grab = true});
  return setup;
}

// Two fingers press a cube from either side, and sway it together.
LoopSetup pinched(double youngs_modulus) {
  LoopSetup setup = cube(youngs_modulus);
  setup.config.styluses = {{0.0, 2000.0, 0.005}, {0.0, 2000.0, 0.005}};
  for (const double side : {-1.0, 1.0}) {
    setup.hands.push_back({.target = [side](double t) {
      const double in = 0.012 * smooth(t, 0.1, 0.5);
      const double up = 0.03 * smooth(t, 0.7, 1.0) * std::sin(2 * M_PI * (t - 0.7));
      return Vector3(side * (kPredictedHalf + 0.004 - in), up, 0.0);
    }});
  }
  return setup;
}

// Two fingertips squeeze a floating cube and move it up by friction alone, which does not slip.
LoopSetup lifted(double youngs_modulus, double depth) {
  LoopSetup setup = cube(youngs_modulus);
  setup.config.objects[0].friction = {1.0, 0.8};
  setup.config.objects[0].damping = {2.0, 2.0};
  setup.config.styluses = {{0.01, 1000.0, 0.0}, {0.01, 1000.0, 0.0}};
  for (const double side : {-1.0, 1.0}) {
    setup.hands.push_back({.target = [side, depth](double t) {
      const double in = depth * smooth(t, 0.1, 0.6);
      const double up = 0.03 * smooth(t, 1.0, 1.8);
      return Vector3(side * (kPredictedHalf + 0.004 - in), up, 0.0);
    }});
  }
  return setup;
}

struct Compared {
  double peak = 0.0;
  LoopRun run;
  double error = 0.0;
};

Compared compare(const LoopSetup& setup, const LoopRun& direct, LoopMode mode,
                 const LoopLink& link) {
  Compared compared{test::peak(direct), run_loop(setup, mode, link)};
  for (std::size_t hand = 0; hand < setup.hands.size(); ++hand) {
    compared.error = std::max(compared.error, largest_error(compared.run, direct, hand));
  }
  return compared;
}

// The largest error of a mode over a link.
double error(const LoopSetup& setup, const LoopRun& direct, LoopMode mode, const LoopLink& link) {
  return compare(setup, direct, mode, link).error;
}

constexpr std::array kStiffnesses{1e3, 2e3, 2e4, 1e5, 1e6};
constexpr std::array kDelays{0.0, 0.002, 0.005, 0.01, 0.02};
constexpr LoopLink kBad{.delay = 0.005, .jitter = 0.01, .loss = 0.05};
constexpr std::array kLinks{LoopLink{},
                            LoopLink{.delay = 0.002},
                            LoopLink{.delay = 0.005},
                            LoopLink{.delay = 0.01},
                            LoopLink{.delay = 0.02},
                            kBad};

}  // namespace

TEST_CASE("prediction: a held point that is swung feels as without delay", "[slow]") {
  for (const double E : kStiffnesses) {
    const LoopSetup setup = swung(E);
    const LoopRun direct = run_loop(setup, LoopMode::kDirect);
    for (const double delay : kDelays) {
      CAPTURE(E, delay);
      const Compared predict = compare(setup, direct, LoopMode::kPredict, {.delay = delay});
      CHECK(predict.error < 1e-6);  // what tables in single precision may cost
      CHECK(predict.run.refused == 0);
      // At the start, before the way is known, it may jump over more steps than a message tells of.
      CHECK(predict.run.lost <= (delay > 0.01 ? 20 - irdm::AppliedForces::kSteps : 0));
    }
    CHECK(error(setup, direct, LoopMode::kPredict, kBad) < 0.01);
    // What the prediction is there for.
    CHECK(error(setup, direct, LoopMode::kHold, {.delay = 0.01}) > (E < 2e4 ? 0.5 : 1e3));
  }
}

TEST_CASE("prediction: forces that come late are entered at their own step") {
  const LoopSetup setup = swung(2e3);
  const LoopRun direct = run_loop(setup, LoopMode::kDirect);
  const Compared predict = compare(setup, direct, LoopMode::kPredict, kBad);
  CHECK(predict.run.late > 500);
  CHECK(predict.run.lost == 0);
  CHECK(predict.error < 0.005);
}

// What is left is the geometry of the steps between, so it falls with the motion: the arm that the
// bridge tells, and the direction of a force that is entered when the body has turned.
TEST_CASE("prediction: what late forces leave falls with the motion", "[slow]") {
  const auto left = [](double way) {
    const LoopSetup setup = swung(1e3, ResponseKind::kModal, way);
    return error(setup, run_loop(setup, LoopMode::kDirect), LoopMode::kPredict, kBad);
  };
  CHECK(left(0.025) < 0.001);
  CHECK(left(0.005) < 2e-4);
}

TEST_CASE("prediction: the same with the dense engine", "[slow]") {
  const LoopSetup setup = swung(2e3, ResponseKind::kDense);
  const LoopRun direct = run_loop(setup, LoopMode::kDirect);
  CHECK(error(setup, direct, LoopMode::kPredict, {.delay = 0.01}) < 1e-6);
  const Compared late = compare(setup, direct, LoopMode::kPredict, kBad);
  CHECK(late.run.late > 10);
  CHECK(late.error < 0.005);
}

TEST_CASE("prediction: a surface that is pressed feels as without delay", "[slow]") {
  for (const double E : kStiffnesses) {
    const LoopSetup setup = pressed(E, 0.0);
    const LoopRun direct = run_loop(setup, LoopMode::kDirect);
    for (const double delay : kDelays) {
      CAPTURE(E, delay);
      CHECK(error(setup, direct, LoopMode::kPredict, {.delay = delay}) < 1e-3);
    }
    CHECK(error(setup, direct, LoopMode::kPredict, kBad) < 0.01);
  }
}

// A tip that slips is between kinetic and static friction, and so is the same tip with a link in
// between, at another moment: in the mean they are at most half a tooth apart, (0.6 - 0.5) /
// |(1, 0.6)| of the force, were they always in opposite phase. The bounds of single steps are
// measured, not derived: one tooth and what is pressed across it, up to 0.09; where the tip goes on
// from another place, by a bad link or on a very soft surface, up to 0.157 and 0.188.
TEST_CASE("prediction: a tip that slides on a surface", "[slow]") {
  const double tooth = (0.6 - 0.5) / std::hypot(1.0, 0.6);
  for (const double E : kStiffnesses) {
    const LoopSetup setup = pressed(E, 0.03);
    const LoopRun direct = run_loop(setup, LoopMode::kDirect);
    for (const LoopLink& link : kLinks) {
      CAPTURE(E, link.delay, link.loss);
      const Compared predict = compare(setup, direct, LoopMode::kPredict, link);
      CHECK(test::rms_error(predict.run, direct) < 0.5 * tooth);
      const bool soft = E < 2e3;
      const double slow_link = soft && link.delay > 0.01 ? 0.2 : 0.1;
      if (link.loss == 0.0) CHECK(predict.error < slow_link);
      if (link.loss == 0.0) continue;
      // A tooth comes some steps early or late there, by the seed.
      LoopSetup other = setup;
      std::vector<double> errors{predict.error};
      for (other.seed = 1; errors.size() < 7; ++other.seed) {
        const Compared again = compare(other, direct, LoopMode::kPredict, link);
        CHECK(test::rms_error(again.run, direct) < 0.5 * tooth);
        errors.push_back(again.error);
      }
      std::sort(errors.begin(), errors.end());
      CHECK(errors[errors.size() / 2] < (soft ? 0.23 : 0.19));
      CHECK(errors.back() < 0.4);
    }
  }
}

// Each hand learns of the other's motion by the link only. A stiff object between two hands is
// beyond that from 5 ms one way on, one of 1e6 N/m^2 from 2 ms.
TEST_CASE("prediction: two hands on one object", "[slow]") {
  for (const double E : {1e3, 2e3}) {
    const LoopSetup setup = by_two(E);
    const LoopRun direct = run_loop(setup, LoopMode::kDirect);
    for (const double delay : {0.0, 0.002, 0.005, 0.01}) {
      CAPTURE(E, delay);
      CHECK(error(setup, direct, LoopMode::kPredict, {.delay = delay}) < 0.06);
    }
  }
  for (const double E : {2e4, 1e5}) {
    const LoopSetup setup = by_two(E);
    const LoopRun direct = run_loop(setup, LoopMode::kDirect);
    CAPTURE(E);
    CHECK(error(setup, direct, LoopMode::kPredict, {.delay = 0.002}) < 0.06);
    CHECK(error(setup, direct, LoopMode::kHold, {.delay = 0.002}) > 1.0);
  }
}

// Each bridge's model has the other finger's contact in it, as it answers.
TEST_CASE("prediction: a pinch by two bridges", "[slow]") {
  for (const double E : {2e3, 2e4}) {
    const LoopSetup setup = pinched(E);
    const LoopRun direct = run_loop(setup, LoopMode::kDirect);
    for (const LoopLink& link : {LoopLink{.delay = 0.002}, LoopLink{.delay = 0.005},
                                 LoopLink{.delay = 0.005, .jitter = 0.001}}) {
      CAPTURE(E, link.delay, link.jitter);
      const Compared predict = compare(setup, direct, LoopMode::kPredict, link);
      CHECK(predict.error < 0.1);
      CHECK(predict.run.energy_from_nowhere < 1e-3);
    }
  }
  const LoopSetup stiff = pinched(1e5);
  CHECK(error(stiff, run_loop(stiff, LoopMode::kDirect), LoopMode::kPredict, {.delay = 0.002}) <
        0.1);
}

// A cube without weight, up to 20 kPa. Not so beyond: with the cube's weight in the fingers the
// error at 20 kPa is 3.3 of the peak, and on a floor 1.2 and more.
TEST_CASE("prediction: a pinch by friction in the air, 10 ms one way", "[slow]") {
  for (const double E : {2e3, 5e3, 2e4}) {
    for (const double depth : {0.014, 0.03}) {
      const LoopSetup setup = lifted(E, depth);
      const LoopRun direct = run_loop(setup, LoopMode::kDirect);
      const Compared predict = compare(setup, direct, LoopMode::kPredict, {.delay = 0.01});
      CAPTURE(E, depth, predict.peak);
      CHECK(predict.error < 0.1);
      CHECK(error(setup, direct, LoopMode::kHold, {.delay = 0.01}) > 1.0);
    }
  }
}

// What the server's overruns leave out it makes up for, with the tips and forces of these steps, so
// that nothing is lost.
TEST_CASE("prediction: overruns of the server are not felt", "[slow]") {
  for (const double E : kStiffnesses) {
    for (LoopSetup setup : {pressed(E, 0.0), swung(E)}) {
      const LoopRun direct = run_loop(setup, LoopMode::kDirect);
      for (const double longest : {0.005, 0.015}) {
        setup.server_overruns = {.every = 0.3, .longest = longest};
        for (setup.seed = 0; setup.seed < 3; ++setup.seed) {
          CAPTURE(E, longest, setup.seed);
          CHECK(error(setup, direct, LoopMode::kPredict, {.delay = 0.01, .jitter = 0.001}) < 1e-3);
        }
      }
    }
  }
}

// In an overrun of the bridge the device goes on showing its force, which is not what the contact
// would give. A stiff tap is as hard as without delay, its bounces come a few steps off. A hand
// that closes on a very soft cube in an overrun holds it elsewhere.
TEST_CASE("prediction: 10 ms one way, jitter and overruns at either side", "[slow]") {
  constexpr double kEqual = 0.1;
  constexpr Overruns kOverruns{.every = 1.0, .longest = 0.005};
  const auto compared = [&](LoopSetup setup, const LoopLink& link, const auto& judge) {
    const LoopRun direct = run_loop(setup, LoopMode::kDirect);
    setup.server_overruns = setup.bridge_overruns = kOverruns;
    for (setup.seed = 0; setup.seed < 5; ++setup.seed) {
      const Compared predict = compare(setup, direct, LoopMode::kPredict, link);
      CAPTURE(setup.seed);
      judge(predict);
    }
  };
  const auto same_course = [&](const Compared& predict) { CHECK(predict.error < kEqual); };
  const auto same_peak = [&](const Compared& predict) {
    CHECK(test::peak(predict.run) == Approx(predict.peak).epsilon(kEqual));
  };
  constexpr LoopLink kLink{.delay = 0.01, .jitter = 0.001};
  for (const double E : kStiffnesses) {
    CAPTURE(E);
    compared(pressed(E, 0.0), kLink, same_course);
    if (E > 1e3) compared(swung(E), kLink, same_course);
    if (E < 1e4) compared(tapped(E), kLink, same_course);
    if (E < 1e6) compared(tapped(E), kLink, same_peak);
  }
  // Overruns of the bridge: up to 0.3 of the peak off.
  LoopSetup pinch = pinched(2e4);
  const LoopRun direct = run_loop(pinch, LoopMode::kDirect);
  pinch.server_overruns = kOverruns;
  for (pinch.seed = 0; pinch.seed < 5; ++pinch.seed) {
    CHECK(error(pinch, direct, LoopMode::kPredict, {.delay = 0.005, .jitter = 0.001}) < kEqual);
  }
}

// Object and hand get what the filter makes of the force, so that the same bridge without delay is
// what it has to be like.
TEST_CASE("prediction: behind the safety filter the device's port gives no energy", "[slow]") {
  for (const double aside : {0.0, 0.03}) {
    for (const double E : kStiffnesses) {
      LoopSetup setup = pressed(E, aside);
      setup.filtered = true;
      setup.hold_horizon_ns = irdm::FilterLimits{}.max_horizon_ns;  // else 20 ms show nothing
      const LoopRun direct = run_loop(setup, LoopMode::kDirect);
      const LoopRun near = run_loop(setup, LoopMode::kPredict);
      for (const double delay : {0.005, 0.02}) {
        CAPTURE(aside, E, delay);
        const Compared predict = compare(setup, near, LoopMode::kPredict, {.delay = delay});
        CHECK(predict.run.lowest_energy[0] > -irdm::PassivityLimits{}.credit);
        CHECK(predict.error < (aside == 0.0 ? 2e-3 : 0.2));
        // Held forces are wrong, but they no longer run away.
        CHECK(error(setup, direct, LoopMode::kHold, {.delay = delay}) < 1.0);
      }
    }
  }
}
