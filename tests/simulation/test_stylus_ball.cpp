// Tips of styluses that are balls: the same contact as that of a ball of the scenery, led by a
// spring, on shapes that a patch of the surface nearest to the tip does not feel.
#include <algorithm>
#include <cmath>

#include "simulation/step/nodal_forces.hpp"
#include "simulation/step/step_rows.hpp"
#include "tests/simulation/coarse_cube.hpp"
#include "tests/simulation/saved_state.hpp"
#include "tests/simulation/touching_cubes.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/voxel_body.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

// One object and a stylus with a ball.
SimulationConfig led_scene(const std::shared_ptr<const Model>& model, double radius,
                           double stiffness) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = model;
  config.objects[0].friction = {0.0, 0.0};
  config.styluses = {{.radius = radius, .coupling_stiffness = stiffness, .ball = true}};
  return config;
}

struct LedBall {
  explicit LedBall(const SimulationConfig& config) : simulation(config) {}

  // Returns the force on the stylus [N], W.
  Vector3 step(const Vector3& tip, bool present = true) {
    StylusCommand command;
    command.present = present;
    command.buttons = grab ? kGrabButton : 0;
    command.tip = tip;
    simulation.step({&command, 1}, *record);
    return record->stylus[0].force;
  }
  // Goes from one place to another at a constant speed, and returns the last force.
  Vector3 go(const Vector3& from, const Vector3& to, double time) {
    const auto steps = std::max(1L, std::lround(time / simulation.dt()));
    Vector3 force = Vector3::Zero();
    for (long k = 1; k <= steps; ++k) {
      force = step(from + static_cast<double>(k) / static_cast<double>(steps) * (to - from));
    }
    return force;
  }
  Vector3 hold(const Vector3& at, double time) { return go(at, at, time); }

  bool grab = false;
  Simulation simulation;
  std::unique_ptr<StepRecord> record = std::make_unique<StepRecord>();
};

Vector3 over_top(double radius, double height, double x = 0.003, double z = 0.002) {
  return {x, kTop + radius + height, z};
}

// Force that holds a ball at a depth [N].
double held_led_force(const SimulationConfig& config, double depth) {
  const double radius = config.styluses[0].radius;
  LedBall run(config);
  run.go(over_top(radius, 0.001), over_top(radius, -depth), 0.2);
  return run.hold(over_top(radius, -depth), 0.3).y();
}

}  // namespace

TEST_CASE("ball of a stylus: without a spring it presses as a ball of the scenery does",
          "[unsanitized]") {
  const double radius = 0.012;
  const double depth = 0.004;
  const SimulationConfig config = led_scene(coarse_cube(), radius, 0.0);
  LedBall run(config);
  SimulationConfig other = config;
  other.styluses.assign(1, {});
  SceneryConfig ball;
  ball.shape = SphereShape{radius};
  ball.position = over_top(radius, 0.001);
  ball.friction = {0.0, 0.0};
  ball.motion.path = {{0.0, Vector3::Zero()}, {0.1, Vector3(0, -depth - 0.001, 0)}};
  other.scenery = {ball};
  Simulation scenery(other);
  const auto record = std::make_unique<StepRecord>();
  for (int k = 1; k <= 100; ++k) {
    const double height = 0.001 - (depth + 0.001) * std::min(1.0, k / 50.0);
    const Vector3 force = run.step(over_top(radius, height));
    step_alone(scenery, *record);
    Vector3 expected = Vector3::Zero();
    for (const BodyContactRecord& contact : record->body_contacts()) expected -= contact.force;
    REQUIRE((force - expected).norm() <= 1e-6 * expected.norm());
  }
  CHECK(run.record->stylus[0].force.y() > 0.02);
  CHECK(run.record->stylus[0].contact == ContactState::kTouching);
  CHECK(run.record->stylus[0].object == 0);
}

TEST_CASE("ball of a stylus: a spring is in series with the contact", "[unsanitized]") {
  const double radius = 0.012;
  const double depth = 0.006;
  const double stiffness = GENERATE(30.0, 300.0);
  SimulationConfig config = led_scene(coarse_cube(), radius, stiffness);
  LedBall run(config);
  const Vector3 at = over_top(radius, -depth);
  run.go(over_top(radius, 0.001), at, 0.2);
  const Vector3 force = run.hold(at, 0.3);
  CHECK(force.y() > 0.02);
  CHECK((stiffness * (run.record->stylus[0].proxy - at) - force).norm() < 1e-9);
  config.styluses[0].coupling_stiffness = 0.0;
  INFO("k " << stiffness << ", force " << force.y());
  CHECK(held_led_force(config, depth - force.y() / stiffness) == Approx(force.y()).epsilon(0.002));
}

TEST_CASE("ball of a stylus: what a step changes comes to the object as momentum") {
  SimulationConfig config = led_scene(fem_cube({.cells = 3, .youngs_modulus = 5e3, .order = 2}),
                                      0.01, GENERATE(0.0, 500.0));
  config.objects[0].position = Vector3(0.01, 0.02, -0.01);
  config.objects[0].friction = {0.5, 0.4};
  LedBall run(config);
  Vector3 before = Vector3::Zero();
  double most = 0.0;
  for (int k = 0; k < 150; ++k) {
    const Vector3 tip = over_top(0.01, 0.021 - 3e-4 * k, 0.001 * k * 0.2, 0.0);
    const Vector3 force = run.step(tip);
    const Vector3 after = momentum(run.simulation).linear;
    REQUIRE((after - before + run.simulation.dt() * force).norm() < 1e-12);
    before = after;
    most = std::max(most, force.norm());
  }
  CHECK(most > 0.02);
}

TEST_CASE("ball of a stylus: it is felt again after its stylus was absent, and not from inside",
          "[unsanitized]") {
  const double radius = 0.01;
  LedBall run(led_scene(coarse_cube(), radius, 300.0));
  const Vector3 deep = over_top(radius, -0.005);
  run.go(over_top(radius, 0.001), deep, 0.1);
  const double held = run.hold(deep, 0.2).y();
  CHECK(held > 0.05);
  CHECK(run.step(deep, false).norm() == 0.0);
  CHECK(run.record->body_contact.empty());
  CHECK(run.record->stylus[0].contact == ContactState::kFree);
  for (int k = 0; k < 100; ++k) run.step(deep, false);
  // It comes again where it overlaps the surface: the force grows from little.
  CHECK(run.step(deep).y() < 0.2 * held);
  CHECK(run.hold(deep, 0.6).y() == Approx(held).epsilon(0.02));
  for (int k = 0; k < 100; ++k) run.step(deep, false);
  const Vector3 inside = Vector3(0.0, 0.02, 0.0);
  CHECK(run.hold(inside, 0.1).norm() == 0.0);
  CHECK(run.go(inside, over_top(radius, 0.01), 0.3).norm() == 0.0);
  run.go(over_top(radius, 0.01), deep, 0.3);
  CHECK(run.hold(deep, 0.2).y() == Approx(held).epsilon(0.02));
}

TEST_CASE("ball of a stylus: between two bodies it is one ball on one spring") {
  const double radius = 0.012;
  SimulationConfig config = led_scene(coarse_cube(), radius, 400.0);
  config.between_objects = GENERATE(true, false);
  config.objects.push_back(config.objects[0]);
  // The second one is the first one turned upside down above it, with a gap narrower than the ball.
  const double gap = 2.0 * radius - 0.006;
  config.objects[1].position = Vector3(0.003, 2.0 * kTop + gap, 0.002);
  config.objects[1].orientation = Quaternion(0, 1, 0, 0);
  config.objects[0].position = Vector3(0.003, 0, 0.002);
  LedBall run(config);
  const Vector3 outside(0.003, kTop + 0.5 * gap, -0.09);
  const Vector3 middle(0.003, kTop + 0.5 * gap, 0.002);
  run.go(outside, middle, 0.8);
  run.hold(middle, 0.3);
  std::array<Vector3, 2> on{Vector3::Zero(), Vector3::Zero()};
  for (const BodyContactRecord& contact : run.record->body_contacts()) {
    if (contact.other < -1 - 0) continue;
    on[static_cast<std::size_t>(contact.object)] += contact.force;
  }
  CHECK(on[0].y() < -0.02);
  CHECK(on[0].y() == Approx(-on[1].y()).epsilon(0.05));
  const Vector3 force = run.record->stylus[0].force;
  CHECK((force + on[0] + on[1]).norm() < 1e-12);
  CHECK((400.0 * (run.record->stylus[0].proxy - middle) - force).norm() < 1e-9);
  // Moved up against the spring, the upper one gets more.
  const Vector3 up = middle + Vector3(0, 0.002, 0);
  CHECK(run.hold(up, 0.3).y() < -0.01);
  CHECK(run.record->stylus[0].object == 1);
}

TEST_CASE("ball of a stylus: it takes hold of what it presses without a jump, pulls, and lets go") {
  const double radius = 0.012;
  const double stiffness = GENERATE(0.0, 300.0);
  LedBall run(led_scene(coarse_cube(), radius, stiffness));
  const Vector3 deep = over_top(radius, -0.004);
  run.grab = true;
  CHECK(run.hold(over_top(radius, 0.001), 0.01).norm() == 0.0);  // it touches nothing
  CHECK(run.record->stylus[0].contact == ContactState::kFree);
  run.grab = false;
  run.go(over_top(radius, 0.001), deep, 0.2);
  const Vector3 pressed = run.hold(deep, 0.3);
  REQUIRE(pressed.y() > 0.02);
  run.grab = true;
  CHECK((run.step(deep) - pressed).norm() < 0.02 * pressed.norm());
  CHECK(run.record->stylus[0].contact == ContactState::kHeld);
  CHECK(run.record->body_contact.empty());
  // It settles at another force, as the patch of the grip is not the contact's.
  CHECK((run.hold(deep, 0.3) - pressed).norm() < 0.1 * pressed.norm());
  // Pulled up it is pulled down, along with the surface; pulled aside it is pulled back.
  const Vector3 up = over_top(radius, 0.006);
  const Vector3 pulled = run.go(deep, up, 0.3);
  CHECK(pulled.y() < -0.02);
  const Vector3 aside = run.go(up, up + Vector3(0.006, 0, 0), 0.3);
  CHECK(aside.x() < -0.01);
  run.go(up + Vector3(0.006, 0, 0), deep, 0.3);
  // Let go while it presses: its own contacts take over.
  const Vector3 again = run.hold(deep, 0.3);
  run.grab = false;
  double largest = 0.0;
  double least = again.norm();
  Vector3 last = again;
  for (int k = 0; k < 200; ++k) {
    const Vector3 force = run.step(deep);
    largest = std::max(largest, (force - last).norm());
    least = std::min(least, force.norm());
    last = force;
  }
  INFO("k " << stiffness << ": pressed " << pressed.y() << ", least " << least << ", step "
            << largest);
  CHECK(largest < 0.15 * pressed.norm());
  CHECK(least > 0.3 * pressed.norm());
  CHECK(run.record->stylus[0].contact == ContactState::kTouching);
  CHECK((last - pressed).norm() < 0.02 * pressed.norm());
  // Let go while it pulls: the force goes to zero.
  run.grab = true;
  run.step(deep);
  run.go(deep, up, 0.3);
  run.grab = false;
  CHECK(run.hold(up, 0.2).norm() == 0.0);
  CHECK(run.record->stylus[0].contact == ContactState::kFree);
}

TEST_CASE(
    "ball of a stylus: let go with its spring stretched by more than its radius it presses on",
    "[unsanitized]") {
  const double radius = 0.01;
  LedBall run(led_scene(coarse_cube(), radius, 10.0));
  const Vector3 inside = over_top(radius, -0.03);
  run.go(over_top(radius, 0.001), inside, 0.6);
  const Vector3 pressed = run.hold(inside, 0.3);
  REQUIRE(pressed.y() / 10.0 > radius);
  run.grab = true;
  run.hold(inside, 0.3);
  run.grab = false;
  CHECK((run.hold(inside, 0.4) - pressed).norm() < 0.03 * pressed.norm());
}

TEST_CASE("ball of a stylus: a rigid body is felt anywhere, however large its triangles") {
  SimulationConfig config = led_scene(
      std::make_shared<const Model>(made_rigid(*fixed_box({.cells = {1, 1, 1}}))), 0.006, 500.0);
  config.objects[0].friction = {0.5, 0.4};
  LedBall run(config);
  for (const double x : {0.0, 0.013, 0.031}) {
    const Vector3 deep = over_top(0.006, -0.003, x, 0.7 * x);
    run.go(over_top(0.006, 0.002, x, 0.7 * x), deep, 0.1);
    const Vector3 force = run.hold(deep, 0.1);
    CHECK(force.y() == Approx(500.0 * 0.003).epsilon(0.05));
    CHECK(std::hypot(force.x(), force.z()) < 0.05 * force.y());
    run.go(deep, over_top(0.006, 0.002, x, 0.7 * x), 0.1);
  }
  config.styluses[0].coupling_stiffness = 0.0;
  CHECK_THROWS_WITH(Simulation(config), Catch::Matchers::ContainsSubstring("without a spring"));
}

TEST_CASE("ball of a stylus: rows, recorded forces and a saved state have its contacts") {
  const double radius = 0.012;
  SimulationConfig config = led_scene(coarse_cube(), radius, 300.0);
  config.objects[0].friction = {0.5, 0.4};
  const auto tip = [&](int k) {
    const double press = std::min(1.0, k / 40.0);
    return over_top(radius, 0.002 - 0.006 * press, 0.003 + 2e-4 * std::max(0, k - 40));
  };
  check_saved_state(config, 60, 60, [&](int k) {
    std::vector<StylusCommand> commands(1);
    commands[0].present = k < 110;
    commands[0].buttons = k > 50 && k < 90 ? kGrabButton : 0;
    commands[0].tip = tip(k);
    return commands;
  });
  LedBall run(config);
  Vector3 force = Vector3::Zero();
  for (int k = 0; k < 80; ++k) force = run.step(tip(k));
  REQUIRE(force.y() > 0.01);
  ContactRows rows(config);
  Vector3 sum = Vector3::Zero();
  for (const ContactRow& row : rows.of(run.simulation, *run.record)) {
    CHECK(row.kind == static_cast<int>(ContactKind::kStylus));
    CHECK(row.other == 0);
    CHECK(row.place >= 0);
    sum += Vector3(row.force[0], row.force[1], row.force[2]);
  }
  CHECK((sum + force).norm() < 1e-12);
  const RestSurface surface(config.objects[0].model->mesh);
  RecordedForces recorded(config, 0, surface);
  sum.setZero();
  for (const NodalForce& nodal : recorded.of(run.record->object[0], run.record->body_contacts())) {
    sum += run.record->object[0].halfway * nodal.force;
  }
  CHECK((sum + force).norm() < 1e-9);
}

TEST_CASE("ball of a stylus: a step does not allocate") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  const double radius = 0.02;
  SimulationConfig config = led_scene(coarse_cube(), radius, 300.0);
  config.objects[0].friction = {0.5, 0.4};
  LedBall run(config);
  const AllocationGuard guard;
  double most = 0.0;
  for (int k = 0; k < 150; ++k) {
    most = std::max(most, run.step(over_top(radius, 0.004 - 2e-4 * k, 2e-4 * k)).norm());
  }
  run.step(Vector3::Zero(), false);
  CHECK(guard.count() == 0);
  CHECK(most > 0.02);
}

TEST_CASE("ball of a stylus: pressed without a spring it is calm and does not kick", "[slow]") {
  // Paper's cube, 5 kPa and 1000 kg/m^3: with a patch of pressure 174 changes and steps of 83 N.
  const double dt = GENERATE(0.0005, 0.001, 0.002);
  VoxelMesh cube{{4, 4, 4}, {}, [](const std::array<int, 3>& at) -> Vector3 {
                   return 0.03 * Vector3(at[0] - 2, at[1] - 2, at[2] - 2);
                 }};
  const auto model = voxel_body(cube, {.dt = dt, .modes = 0});
  const double radius = 0.012;
  LedBall run(led_scene(model, radius, 0.0));
  const Vector3 above = over_top(radius, 0.003);
  const Vector3 deep = over_top(radius, -0.01);
  int changes = 0;
  bool touching = false;
  double most = 0.0;
  const auto go = [&](const Vector3& from, const Vector3& to, double time) {
    const auto steps = std::lround(time / dt);
    double last = 0.0;
    for (long k = 1; k <= steps; ++k) {
      last = run.step(from + static_cast<double>(k) / static_cast<double>(steps) * (to - from)).y();
      if ((last > 0.0) != touching) ++changes;
      touching = last > 0.0;
      most = std::max(most, last);
    }
    return last;
  };
  go(above, deep, 0.013 / 0.06);
  const double held = go(deep, deep, 0.5);
  go(deep, above, 0.013 / 0.06);
  INFO("dt " << dt << ": held " << held << " N, at most " << most << ", changes " << changes);
  CHECK(changes == 2);
  CHECK(held > 0.2);
  CHECK(most < 1.6 * held);
}
