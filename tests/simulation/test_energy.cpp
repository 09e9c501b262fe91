// What styluses put in and get out, and that nothing blows up.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>

#include "tests/simulation/pressed_cube.hpp"
#include "tests/simulation/random_numbers.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

// What a stylus did to the objects.
struct Work {
  double net = 0.0;    // [J]
  double gross = 0.0;  // the sum of what it put in [J]
  void add(const StylusRecord& stylus, const Vector3& tip, const Vector3& last) {
    const double done = -stylus.force.dot(tip - last);
    net += done;
    gross += std::max(0.0, done);
  }
};

// 0, up to 1 and back to 0 between two times.
double hump(double t, double from, double to) {
  const double s = std::sin(std::numbers::pi * std::clamp((t - from) / (to - from), 0.0, 1.0));
  return s * s;
}

enum class Cycle { kPress, kSlide, kSwing };

// A closed motion of 1.6 s: down on the top and up again; dragged along while it is down; or taking
// hold there, swinging and coming back.
struct Motion {
  Motion(Random& random, Cycle kind)
      : cycle(kind),
        where(between(random, -0.05, 0.05), kHalfEdge, between(random, -0.05, 0.05)),
        aside(anywhere(random, 0.04)),
        depth(between(random, 0.001, 0.008)) {
    if (kind == Cycle::kPress) aside.setZero();
    if (kind == Cycle::kSlide) aside.y() = 0.0;
  }
  Vector3 tip(double t) const {
    const double down = 0.005 - (0.005 + depth) * hump(t, 0.0, 1.6);
    return where + Vector3(0, down, 0) + hump(t, 0.5, 1.1) * aside;
  }
  bool grab(double t) const { return cycle == Cycle::kSwing && t > 0.45 && t < 1.15; }

  Cycle cycle;
  Vector3 where, aside;
  double depth;
};

Work play(const SimulationConfig& config, const Motion& motion) {
  Simulation simulation(config);
  StepRecord record;
  Work work;
  Vector3 last = motion.tip(0.0);
  for (int k = 1; k <= 900; ++k) {
    const double t = 0.002 * k;
    const Vector3 tip = motion.tip(t);
    const StylusCommand command = at_tip(tip, motion.grab(t));
    simulation.step({&command, 1}, record);
    work.add(record.stylus[0], tip, last);
    last = tip;
  }
  return work;
}

void check_cycles(ResponseKind kind, int cycles, unsigned seed) {
  Random random(seed);
  double least = 1.0;
  int touched = 0;
  for (int i = 0; i < cycles; ++i) {
    const double radius = i % 2 == 0 ? 0.0 : between(random, 0.005, 0.02);
    const double kinetic = between(random, 0.0, 0.8);
    SimulationConfig config = tethered({}, radius, {kinetic * between(random, 1.0, 1.3), kinetic});
    config.objects[0].model = fem_cube({3}, kind);
    if (i % 4 < 2) config.styluses[0].coupling_stiffness = 0.0;
    if (i % 5 == 0) config.objects[0].tether = {};  // in free flight
    const Motion motion(random, static_cast<Cycle>(i % 3));
    const Work work = play(config, motion);
    INFO("cycle " << i << ": " << work.net << " J of " << work.gross << " J");
    CHECK(work.net >= -0.01 * work.gross);
    if (work.gross == 0.0) continue;  // it never came down
    ++touched;
    least = std::min(least, work.net / work.gross);
  }
  CHECK(touched > cycles * 3 / 4);
  std::cout << cycles << " cycles: the stylus got out at most " << -100.0 * least
            << " % of what it put in\n";
}

}  // namespace

TEST_CASE("energy: over closed cycles a stylus never gets out more than it put in, modal",
          "[slow]") {
  check_cycles(ResponseKind::kModal, 140, 5);
}

TEST_CASE("energy: over closed cycles a stylus never gets out more than it put in, dense",
          "[slow]") {
  check_cycles(ResponseKind::kDense, 60, 6);
}
