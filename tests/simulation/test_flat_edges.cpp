// Edges of bodies that come to lie flat, and turn up again.
#include <algorithm>
#include <cmath>

#include "tests/simulation/touching_cubes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kPlane = -1;
constexpr double kFlatBelow =
    0.0524;  // by less than this a face is turned from one that it lies on [rad]

/// How deep its deepest node is below y = 0 [m].
double deepest_below(const SoftObject& object) {
  Points u;
  object.engine().displacement(u);
  double deepest = 0.0;
  for (int i = 0; i < object.model().mesh.surface_node_count(); ++i) {
    const Vector3 place = object.model().mesh.rest_position(i) + Vector3(u.row(i).transpose());
    deepest =
        std::max(deepest, -(object.state().position + object.state().orientation * place).y());
  }
  return deepest;
}

/// From the horizontal [rad].
double tilt_of(const SoftObject& object) {
  return std::asin((object.state().orientation * Vector3::UnitX()).y());
}

/// A cube on a plane, or on a box.
SimulationConfig one_on(bool box, double youngs_modulus) {
  SimulationConfig config =
      stacked(1, {.cells = 4, .youngs_modulus = youngs_modulus, .poisson_ratio = 0.45}, {0.6, 0.5});
  config.objects[0].damping = {5.0, 5.0};
  if (box) {
    config.scenery[0].shape = BoxShape{Vector3(0.3, 0.1, 0.3)};
    config.scenery[0].position.y() = -0.05;
  }
  return config;
}

}  // namespace

// A hand that holds the top at one side lifts it and lets it down: the cube turns about the edge at
// the other side, which carries half of it and lies flat below 3 degrees.
TEST_CASE("body contacts: an edge that turns flat hands its force over, and none is lost in a step",
          "[slow]") {
  const bool box = GENERATE(false, true);
  const double youngs_modulus = GENERATE(5e3, 2e4);
  constexpr double kSpeed = 0.02;      // [m/s]
  constexpr double kHighest = 0.0195;  // [m]
  SimulationConfig config = one_on(box, youngs_modulus);
  config.styluses = {{0.0, 1000.0, 0.01}};
  Simulation simulation(config);
  const SoftObject& cube = simulation.object();
  const double mass = cube.model().body.mass;
  const double dt = simulation.dt();
  const double damped = std::exp(-0.5 * dt * config.objects[0].damping.linear);
  const auto record = std::make_unique<StepRecord>();
  double largest = 0.0;
  double unbalanced = 0.0;
  double most_tilted = 0.0;
  double deepest = 0.0;
  double before = 0.0;
  for (int k = 0; k < 1800; ++k) {
    const double t = k * dt;
    const double lowered = std::max(-0.01, kHighest - kSpeed * (t - 2.0));
    const double up = std::min({std::max(0.0, kSpeed * (t - 0.6)), kHighest, lowered});
    StylusCommand hand = at_tip(Vector3(kHalfEdge, 2 * kHalfEdge + up, 0), t > 0.4);
    hand.present = t > 0.3;
    const Vector3 velocity = cube.state().velocity;
    simulation.step({&hand, 1}, *record);
    const Vector3 carried = force_between(*record, 0, kPlane);
    const Vector3 gained = cube.state().velocity / damped - velocity * damped;
    const Vector3 force = carried - record->stylus[0].force + mass * config.gravity;
    unbalanced = std::max(unbalanced, (mass * gained - dt * force).norm());
    // Until the whole face comes down.
    if (tilt_of(cube) > 0.1 * kFlatBelow)
      largest = std::max(largest, std::abs(carried.y() - before));
    if (k % 10 == 0) deepest = std::max(deepest, deepest_below(cube));
    most_tilted = std::max(most_tilted, tilt_of(cube));
    before = carried.y();
  }
  INFO("box " << box << ", E " << youngs_modulus << ": changes by up to " << largest
              << " N a step of " << kGravity * mass << " N, momentum off by " << unbalanced
              << " N s, deepest node " << deepest << " m");
  CHECK(most_tilted > 1.2 * kFlatBelow);
  CHECK(tilt_of(cube) < 0.8 * kFlatBelow);
  // The hand's spring changes by 0.04 N a step, and what comes down is stopped within one.
  CHECK(largest < 0.1 * kGravity * mass);
  CHECK(unbalanced < 1e-12);
  CHECK(deepest < 5e-4);
}

TEST_CASE("body contacts: momentum stays in a collision in which an edge turns flat",
          "[unsanitized]") {
  SimulationConfig config;
  config.objects.resize(2);
  for (SimulationObject& object : config.objects) {
    object.model = fem_cube({.cells = 4, .poisson_ratio = 0.45});
  }
  config.objects[1].position.y() = 0.135;
  config.objects[1].orientation = Quaternion(Eigen::AngleAxisd(0.07, Vector3::UnitZ()));
  config.objects[1].velocity.y() = -0.1;
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  Momentum before = momentum(simulation);
  double off = 0.0;
  int steep = 0;
  int flat = 0;
  for (int k = 0; k < 250; ++k) {
    step_alone(simulation, *record);
    const Momentum after = momentum(simulation);
    off = std::max(off, change(before, after));
    before = after;
    if (record->body_contacts().empty()) continue;
    ++(tilt_of(simulation.object(1)) > kFlatBelow ? steep : flat);
  }
  INFO("off by " << off << ", " << steep << " steps of contact on an edge, " << flat << " flat");
  CHECK(off < 1e-15);
  CHECK(steep > 3);
  CHECK(flat > 3);
}

// Turned by less than 3 degrees a face counts as flat, and its samples are up to 1.4 cm away from
// its edges.
TEST_CASE("body contacts: edges of a cube that lands nearly flat do not sink in", "[slow]") {
  const bool box = GENERATE(false, true);
  const Vector3 turn = GENERATE(Vector3(0, 0, 0.05), Vector3(0.03, 0, 0.03));
  SimulationConfig config = one_on(box, 2000.0);
  config.objects[0].position.y() += 0.005;
  config.objects[0].orientation = Quaternion(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  double deepest = 0.0;
  for (int k = 0; k < 1500; ++k) {
    step_alone(simulation, *record);
    deepest = std::max(deepest, deepest_below(simulation.object()));
  }
  INFO("box " << box << ", turned by " << turn.transpose() << ": deepest node " << deepest << " m");
  CHECK(deepest < 5e-4);
  CHECK(force_between(*record, 0, kPlane).y() ==
        Approx(kGravity * simulation.object().model().body.mass).epsilon(1e-3));
}
