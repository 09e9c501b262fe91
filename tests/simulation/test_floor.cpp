// Objects that rest and slide on the floor.
#include <cmath>
#include <numbers>

#include "simulation/deformation/deformation.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

// A cube that stands on the floor, which is at its lower face.
SimulationConfig standing(double youngs_modulus, const Friction& friction) {
  FemCube cube;
  cube.youngs_modulus = youngs_modulus;
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fem_cube(cube);
  config.gravity = Vector3(0, -kGravity, 0);
  config.floor = FloorConfig{Vector3(0, 1, 0), -kHalfEdge, friction};
  return config;
}

// The same on a slope down along x, at an angle [rad] and with a speed along it [m/s].
SimulationConfig on_slope(double angle, const Friction& friction, double speed = 0.0) {
  SimulationConfig config = standing(2e5, friction);
  config.gravity = kGravity * Vector3(std::sin(angle), -std::cos(angle), 0);
  config.objects[0].velocity = Vector3(speed, 0, 0);
  return config;
}

void step(Simulation& simulation, StepRecord& record) {
  const StylusCommand nobody;
  simulation.step({&nobody, 1}, record);
}

}  // namespace

TEST_CASE("floor: at rest it carries the weight, and nothing moves", "[slow]") {
  Simulation simulation(standing(2000.0, {0.5, 0.5}));
  const double weight = simulation.object().model().body.mass * kGravity;
  StepRecord record;
  Vector3 position = Vector3::Zero();
  double drift = 0.0;
  double off = 0.0;
  for (int k = 0; k < 30'000; ++k) {  // 60 s
    step(simulation, record);
    if (k == 5000) position = record.object[0].position;
    if (k < 5000) continue;
    drift = std::max(drift, (record.object[0].position - position).norm());
    off = std::max(off, (record.object[0].floor_force - Vector3(0, weight, 0)).norm());
  }
  INFO("drift " << drift << " m, force off by " << off << " of " << weight << " N, "
                << record.object[0].floor_count << " nodes down, residual "
                << record.object[0].residual);
  CHECK(drift < 1e-5);
  CHECK(off < 1e-3 * weight);
  CHECK(record.object[0].floor_count >= 20);
  // It sags under its own weight: the middle comes down by about rho g L^2 / (2 E).
  CHECK(record.object[0].position.y() < -0.001);
}

TEST_CASE("floor: dropped it rings and comes to rest on the floor, no node below it", "[slow]") {
  SimulationConfig config = standing(2000.0, {0.5, 0.5});
  config.objects[0].position = Vector3(0, 0.05, 0);
  config.objects[0].damping = {0.5, 0.5};
  Simulation simulation(config);
  Deformation deformation(config);
  SurfaceFrame frame = rest_frame(config);
  StepRecord record;
  bool flew = false;
  double deepest = 0.0;
  for (int k = 0; k < 5000; ++k) {
    step(simulation, record);
    deformation.follow(record);
    if (k < 40) flew = flew || record.object[0].floor_count == 0;
    if (k % 50 != 0) continue;
    deformation.compute(frame);
    const ModelMesh& mesh = config.objects[0].model->mesh;
    for (int i = 0; i < mesh.surface_node_count(); ++i) {
      deepest = std::max(deepest, -kHalfEdge - frame.objects[0].world(mesh, i).y());
    }
  }
  CHECK(flew);
  CHECK(deepest < 1e-3);
  CHECK(record.object[0].velocity.norm() < 1e-3);
}

TEST_CASE("floor: a block slides from the friction angle on, within half a degree",
          "[unsanitized]") {
  const double mu = 0.4;
  const double angle = std::atan(mu);
  for (const double off : {-0.5, 0.5}) {
    const double tilt = angle + off * std::numbers::pi / 180.0;
    Simulation simulation(on_slope(tilt, {mu, mu}));
    StepRecord record;
    double early = 0.0;
    for (int k = 0; k < 2000; ++k) {
      step(simulation, record);
      if (k == 1000) early = record.object[0].position.x();
    }
    const double went = record.object[0].position.x() - early;
    INFO(off << " degrees: " << went << " m in 2 s");
    if (off < 0) CHECK(std::abs(went) < 1e-5);
    // g (sin - mu cos) t^2 / 2 from 2 s to 4 s
    if (off > 0) CHECK(went > 0.5 * 6.0 * kGravity * (std::sin(tilt) - mu * std::cos(tilt)));
  }
}

TEST_CASE("floor: a sliding block slows down by mu g within 1 %", "[unsanitized]") {
  const double mu = 0.3;
  SimulationConfig config = standing(2e5, {mu, mu});
  config.objects[0].velocity = Vector3(1.0, 0, 0);
  Simulation simulation(config);
  StepRecord record;
  double first = 0.0;
  for (int k = 0; k < 120; ++k) {
    step(simulation, record);
    if (k == 19) first = record.object[0].velocity.x();
  }
  const double found = (first - record.object[0].velocity.x()) / (100 * simulation.dt());
  CHECK(found == Approx(mu * kGravity).epsilon(0.01));
}

TEST_CASE("floor: pushed along, a block slides at mu M g within 1 %", "[unsanitized]") {
  const double mu = 0.3;
  SimulationConfig config = standing(2e5, {mu, mu});
  config.styluses = {{0.0, 500.0, 0.0}};
  config.objects[0].friction = {0.0, 0.0};  // the tip carries no weight
  Simulation simulation(config);
  const double limit = mu * simulation.object().model().body.mass * kGravity;
  StepRecord record;
  double start = -1.0;
  double last = 0.0;
  double sum = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double t = 0.002 * (k + 1);
    const StylusCommand push{true, 0, Vector3(-kHalfEdge - 0.001 + 0.002 * t, 0.0, 0.0), {}};
    simulation.step({&push, 1}, record);
    if (start < 0 && record.object[0].velocity.x() > 1e-3) start = last;
    last = -record.stylus[0].force.x();
    if (k >= 1500) sum += last / 500.0;
  }
  INFO("starts at " << start << " N, slides at " << sum << " N, mu M g = " << limit << " N");
  CHECK(sum == Approx(limit).epsilon(0.01));
}

// On a slope between the two angles of friction what slides goes on sliding, by kinetic friction
// alone, even where it turns round.
TEST_CASE("floor: a block that was thrown up a slope comes down again by kinetic friction",
          "[unsanitized]") {
  const Friction friction{0.8, 0.2};
  const double tilt = std::atan(0.5);
  Simulation simulation(on_slope(tilt, friction, -0.6));
  const double up = kGravity * (std::sin(tilt) + friction.kinetic * std::cos(tilt));
  const double down = kGravity * (std::sin(tilt) - friction.kinetic * std::cos(tilt));
  StepRecord record;
  std::vector<double> velocity;
  for (int k = 0; k < 300; ++k) {
    step(simulation, record);
    velocity.push_back(record.object[0].velocity.x());
  }
  const double dt = simulation.dt();
  // It comes down with a jerk, and turns after 0.1 s.
  CHECK((velocity[40] - velocity[20]) / (20 * dt) == Approx(up).epsilon(0.01));
  CHECK((velocity[299] - velocity[60]) / (239 * dt) == Approx(down).epsilon(0.01));
}

// At 2 cm/s static friction would hold the nodes if they were taken to be at rest.
TEST_CASE("floor: a block that slides slowly goes on sliding, by kinetic friction",
          "[unsanitized]") {
  const Friction friction{0.8, 0.2};
  for (const double slope : {0.2, 0.15}) {
    CAPTURE(slope);
    const double tilt = std::atan(slope);
    Simulation simulation(on_slope(tilt, friction, slope == 0.2 ? 0.02 : 0.1));
    StepRecord record;
    double early = 0.0;
    for (int k = 0; k < 96; ++k) {
      step(simulation, record);
      if (k == 20) early = record.object[0].velocity.x();
    }
    const double gained =
        75 * simulation.dt() * kGravity * (std::sin(tilt) - friction.kinetic * std::cos(tilt));
    CHECK(early > 0.02);
    CHECK(record.object[0].velocity.x() - early == Approx(gained).epsilon(0.01).margin(5e-4));
  }
}

// Held by its top and shaken up and down above the floor, so that it hangs by up to 15 mm more than
// at rest.
TEST_CASE("floor: a node that hangs far below where it is at rest does not go through",
          "[unsanitized]") {
  SimulationConfig config = standing(1000.0, {0.5, 0.5});
  config.objects[0].position = Vector3(0, 0.05, 0);
  config.styluses = {{0.0, 0.0, 0.02}};
  Simulation simulation(config);
  Deformation deformation(config);
  SurfaceFrame frame = rest_frame(config);
  const ModelMesh& mesh = config.objects[0].model->mesh;
  StepRecord record;
  double deepest = 0.0;
  double most_below_rest = 0.0;  // of the nodes that are on the floor
  for (int k = 0; k < 1500; ++k) {
    const double t = simulation.dt() * k;
    const double shaken = 0.01 * std::sin(2.0 * std::numbers::pi * 5.0 * t);
    const double y = kHalfEdge + 0.05 - 0.02 * std::min(t, 1.0) + shaken;
    const StylusCommand held{true, kGrabButton, Vector3(0, y, 0), {}};
    simulation.step({&held, 1}, record);
    deformation.follow(record);
    deformation.compute(frame);
    const auto& object = frame.objects[0];
    for (int i = 0; i < mesh.surface_node_count(); ++i) {
      const double height = object.world(mesh, i).y() + kHalfEdge;
      const Vector3 at_rest = object.position + object.orientation * mesh.rest_position(i);
      deepest = std::max(deepest, -height);
      if (height > 1e-4) continue;
      most_below_rest = std::max(most_below_rest, at_rest.y() + kHalfEdge - height);
    }
  }
  INFO("deepest " << deepest << " m, below rest by " << most_below_rest << " m");
  CHECK(deepest < 1e-5);
  CHECK(most_below_rest > 0.01);
}

TEST_CASE("floor: the proxy is where the floor, too, presses the touched point") {
  Simulation simulation(standing(1e6, {0.5, 0.4}));
  const ModelMesh& mesh = simulation.object().model().mesh;
  StepRecord record;
  Points u;
  int touching = 0;
  for (int k = 0; k < 200; ++k) {
    const StylusCommand command = at_tip({0.01, kHalfEdge + 5e-4 - 1e-5 * k, 0.01});
    simulation.step({&command, 1}, record);
    const ObjectRecord& object = record.object[0];
    const ContactRecord& contact = object.contact[0];
    if (contact.state == ContactState::kFree || object.floor_count == 0) continue;
    ++touching;
    simulation.object().engine().displacement(u);
    const Vector3 place = interpolate(contact.point, [&](int i) -> Vector3 {
      return mesh.rest_position(i) + u.row(i).transpose();
    });
    // But for the floor's forces, which act rounded to single precision.
    CHECK((contact.proxy - object.position - object.orientation * place).norm() < 1e-10);
  }
  CHECK(touching > 50);
}

TEST_CASE("floor: reset puts everything back", "[unsanitized]") {
  Simulation simulation(standing(2000.0, {0.5, 0.5}));
  StepRecord first, second;
  for (int k = 0; k < 300; ++k) step(simulation, first);
  simulation.reset();
  for (int k = 0; k < 300; ++k) step(simulation, second);
  CHECK(first.object[0].position == second.object[0].position);
  CHECK(first.object[0].floor_force == second.object[0].floor_force);
}
