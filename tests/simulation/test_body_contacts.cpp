// Objects that touch each other and scenery.
#include <cmath>
#include <numbers>

#include "simulation/deformation/deformation.hpp"
#include "tests/simulation/touching_cubes.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kFirstScenery = -1;

// Two cubes in free space that fly at each other, a little aside, and turn.
SimulationConfig colliding(const FemCube& cube, double speed) {
  SimulationConfig config;
  config.objects.resize(2);
  for (SimulationObject& object : config.objects) object.model = fem_cube(cube);
  config.objects[0].position = Vector3(-0.08, 0.0, 0.0);
  config.objects[1].position = Vector3(0.08, 0.02, 0.01);
  config.objects[0].velocity = Vector3(speed, 0, 0);
  config.objects[1].velocity = Vector3(-speed, 0, 0);
  config.objects[0].angular_velocity = Vector3(1.0, 2.0, 3.0);
  return config;
}

// For so long after ten seconds in which they settle. @param most drift then [m]
void check_three_at_rest(double duration, double most) {
  for (const double youngs_modulus : {2e4, 1e6}) {
    const SimulationConfig config =
        stacked(3, {.cells = 4, .youngs_modulus = youngs_modulus}, {0.6, 0.5});
    Simulation simulation(config);
    const double weight = config.objects[0].model->body.mass * kGravity;
    const auto record = std::make_unique<StepRecord>();
    std::array<Vector3, 3> settled;
    double drift = 0.0;
    double off = 0.0;
    const int steps = 5'000 + static_cast<int>(std::lround(duration / config.objects[0].model->dt));
    for (int k = 0; k < steps; ++k) {
      step_alone(simulation, *record);
      if (k < 5'000) continue;
      for (int i = 0; i < 3; ++i) {
        const auto index = static_cast<std::size_t>(i);
        if (k == 5'000) settled[index] = record->object[index].position;
        drift = std::max(drift, (record->object[index].position - settled[index]).norm());
        const Vector3 force = force_between(*record, i, i - 1);
        off = std::max(off, (force - Vector3(0, (3 - i) * weight, 0)).norm() / weight);
      }
    }
    INFO("E " << youngs_modulus << ": drift in " << duration << " s " << drift
              << " m, force off by " << off << " of a cube's weight");
    CHECK(drift < most);
    CHECK(off < 1e-3);
  }
}

}  // namespace

TEST_CASE("bodies: three cubes at rest carry the weight above each, and do not drift", "[slow]") {
  check_three_at_rest(4.0, 2e-6);  // they are still settling, by less and less
}

TEST_CASE("bodies: three cubes at rest, the same for a minute", "[exhaustive]") {
  check_three_at_rest(60.0, 1e-5);
}

TEST_CASE("bodies: a soft cube on a soft cube slips from the friction angle on", "[slow]") {
  const double mu = 0.2;
  for (const double off : {-0.5, 0.5}) {
    const double tilt = std::atan(mu) + off * std::numbers::pi / 180.0;
    SimulationConfig config = stacked(2, {.cells = 4, .youngs_modulus = 2e5}, {mu, mu});
    // Above about 1.5 a patch at an edge has no solution that sweeps find: mu W_nt > W_nn.
    config.scenery[0].friction = {1.0, 1.0};
    Simulation simulation(config);
    const auto record = std::make_unique<StepRecord>();
    const auto way = [&](int steps) {
      const double before = record->object[1].position.x() - record->object[0].position.x();
      for (int k = 0; k < steps; ++k) step_alone(simulation, *record);
      return record->object[1].position.x() - record->object[0].position.x() - before;
    };
    way(1000);
    // Tilted gradually: a sudden change would make the cubes rock.
    Settings settings = simulation.settings();
    for (int k = 1; k <= 500; ++k) {
      const double now = tilt * k / 500.0;
      settings.gravity = kGravity * Vector3(std::sin(now), -std::cos(now), 0);
      simulation.set(settings);
      way(1);
    }
    way(50);
    const double early = way(50);
    way(100);
    const double late = way(50);
    INFO(off << " degrees: " << early << " m in 0.1 s, " << late << " m in 0.1 s 0.3 s later");
    if (off < 0) CHECK(std::abs(late) < 1e-6);  // what is left of the swing that tilting made
    if (off < 0) continue;
    // v' = p - v with p = g (sin - mu cos), the damping being 1/s: p as an angle.
    const double speed = early / 0.1;
    const double pull = speed + (late / 0.1 - speed) / (1.0 - std::exp(-0.3));
    const double formula = kGravity * (std::sin(tilt) - mu * std::cos(tilt));
    const double wrong = (pull - formula) / kGravity * 180.0 / std::numbers::pi;
    INFO("as if the slope were steeper by " << wrong << " degrees");
    CHECK(std::abs(wrong) < 0.15);
  }
}

TEST_CASE("bodies: momentum and angular momentum of a world stay in each step to 1e-10") {
  for (const double youngs_modulus : {2e3, 1e6}) {
    const SimulationConfig config =
        colliding({.cells = 3, .youngs_modulus = youngs_modulus, .dt = 0.001}, 0.5);
    Simulation simulation(config);
    const auto record = std::make_unique<StepRecord>();
    Momentum before = momentum(simulation);
    double off = 0.0;
    double largest = 0.0;
    int touched = 0;
    for (int k = 0; k < 300; ++k) {
      step_alone(simulation, *record);
      const Momentum after = momentum(simulation);
      off = std::max(off, change(before, after));
      before = after;
      largest = std::max(largest, force_between(*record, 0, 1).norm());
      touched += !record->body_contact.empty() ? 1 : 0;
    }
    INFO("E " << youngs_modulus << ": off by " << off << ", largest force " << largest << " N, "
              << touched << " steps in contact");
    CHECK(off < 1e-10);
    CHECK(touched > 5);
    CHECK(record->object[0].velocity.x() < 0.3);
  }
}

TEST_CASE("bodies: a collision makes no energy", "[slow]") {
  for (const double youngs_modulus : {1e3, 2e4, 1e6}) {
    for (const double dt : {0.002, 0.001}) {
      const SimulationConfig config =
          colliding({.cells = 3, .youngs_modulus = youngs_modulus, .dt = dt}, 0.5);
      Simulation simulation(config);
      const auto energy = [&] {
        double sum = 0.0;
        for (int i = 0; i < 2; ++i) {
          const SoftObject& object = simulation.object(i);
          sum += rigid_energy(object.rigid(), {}, object.state());
        }
        return sum;
      };
      const double before = energy();
      const auto record = std::make_unique<StepRecord>();
      double most = 0.0;
      for (int k = 0; k * dt < 1.0; ++k) {
        step_alone(simulation, *record);
        most = std::max(most, energy());
      }
      INFO("E " << youngs_modulus << ", dt " << dt << ": " << before << " J, at most " << most
                << ", in the end " << energy());
      CHECK(most < 1.0001 * before);
      CHECK(energy() < before);
    }
  }
}

TEST_CASE("bodies: a fast one does not pass through another, nor through scenery") {
  for (const double speed : {5.0, 30.0}) {
    SimulationConfig config = colliding({.cells = 3, .youngs_modulus = 2e5}, speed);
    config.objects[0].angular_velocity.setZero();
    SceneryConfig ball;
    ball.shape = SphereShape{0.02};
    ball.position = Vector3(-1.0, 0, 0);
    config.scenery = {ball};
    Simulation simulation(config);
    const auto record = std::make_unique<StepRecord>();
    for (int k = 0; k < 50; ++k) step_alone(simulation, *record);
    INFO(speed << " m/s: " << record->object[0].position.transpose() << ", "
               << record->object[1].position.transpose());
    CHECK(record->object[0].position.x() < record->object[1].position.x());
  }
  SimulationConfig config = stacked(1, {.cells = 3, .youngs_modulus = 2e5}, {0.5, 0.5});
  config.objects[0].position.y() = 0.3;
  config.objects[0].velocity = Vector3(0, -60.0, 0);
  config.scenery[0].shape = BoxShape{Vector3(1.0, 0.01, 1.0)};
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 200; ++k) step_alone(simulation, *record);
  CHECK(record->object[0].position.y() > 0.0);
}

// Nothing but the fingers moves. The face that bulges by more than 6 mm was at first farther from
// the other than samples at rest are looked at.
TEST_CASE("bodies: one that fingers make bulge comes to touch what is beside it") {
  constexpr double kFace = 0.06;  // from the centre [m]
  constexpr double kGap = 0.004;
  const bool soft = GENERATE(false, true);
  SimulationConfig config;
  config.objects.resize(soft ? 2 : 1);
  for (SimulationObject& object : config.objects) object.model = fem_cube({.cells = 3});
  config.objects[0].tether = {1000.0, 10.0};
  config.objects[0].damping = {20.0, 20.0};
  if (soft) {
    config.objects[1].position.z() = 2.0 * kFace + kGap;
  } else {
    config.scenery.resize(1);
    config.scenery[0].shape = BoxShape{Vector3(0.2, 0.2, 0.02)};
    config.scenery[0].position.z() = kFace + kGap + 0.01;
  }
  config.styluses.assign(2, {0.015, 2000.0, 0.0});
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  double impulse = 0.0;
  constexpr int kSteps = 400;
  for (int k = 0; k < kSteps; ++k) {
    const double x = kFace + 0.002 - 0.016 * k / kSteps;
    simulation.step(std::vector<StylusCommand>{{true, 0, Vector3(x, 0, 0), std::nullopt},
                                               {true, 0, Vector3(-x, 0, 0), std::nullopt}},
                    *record);
    for (const BodyContactRecord& contact : record->body_contacts()) {
      impulse += config.objects[0].model->dt * std::abs(contact.force.z());
    }
    if (k < 100) CHECK(record->body_contacts().empty());
  }
  INFO((soft ? "soft" : "scenery") << ": " << impulse << " N s");
  CHECK(impulse > 0.001);  // of 0.2 kg that go away as fast as the face bulges, some 8 mm/s
  Points u;
  simulation.object(0).engine().displacement(u);
  const ModelMesh& mesh = simulation.object(0).model().mesh;
  double deepest = 0.0;
  for (int i = 0; !soft && i < mesh.surface_node_count(); ++i) {
    const Vector3 x =
        simulation.object(0).state().position +
        simulation.object(0).state().orientation * (mesh.rest_position(i) + u.row(i).transpose());
    deepest = std::max(deepest, x.z() - kFace - kGap);
  }
  CHECK(deepest < 0.0005);
}

TEST_CASE("bodies: the same commands give the same bits, after a reset as well", "[slow]") {
  const SimulationConfig config = stacked(2, {.cells = 3, .youngs_modulus = 2e4}, {0.5, 0.4});
  Simulation first(config);
  Simulation second(config);
  const auto one = std::make_unique<StepRecord>();
  const auto two = std::make_unique<StepRecord>();
  for (int k = 0; k < 150; ++k) step_alone(second, *two);
  second.reset();
  for (int k = 0; k < 200; ++k) {
    step_alone(first, *one);
    step_alone(second, *two);
    REQUIRE(one->body_contact.size() == two->body_contact.size());
    for (int i = 0; i < 2; ++i) {
      const auto index = static_cast<std::size_t>(i);
      REQUIRE(one->object[index].position == two->object[index].position);
      REQUIRE(one->object[index].orientation.coeffs() == two->object[index].orientation.coeffs());
    }
    for (std::size_t c = 0; c < one->body_contacts().size(); ++c) {
      REQUIRE(one->body_contact[c].force == two->body_contact[c].force);
    }
  }
}

TEST_CASE("bodies: what is shown of them is what the step has") {
  const SimulationConfig config = stacked(2, {.cells = 3, .youngs_modulus = 2e3}, {0.5, 0.4});
  Simulation simulation(config);
  Deformation deformation(config);
  SurfaceFrame frame = rest_frame(config);
  const auto record = std::make_unique<StepRecord>();
  Points u;
  for (int k = 0; k < 300; ++k) {
    step_alone(simulation, *record);
    deformation.follow(*record);
    if (k == 100) deformation.compute(frame);  // an earlier frame, which the next one replaces
  }
  deformation.compute(frame);
  for (int i = 0; i < 2; ++i) {
    simulation.object(i).engine().displacement(u);
    CHECK(u.norm() > 1e-3);
    CHECK((frame.objects[static_cast<std::size_t>(i)].displacement - u).norm() < 1e-12);
  }
  REQUIRE(!record->body_contact.empty());
  REQUIRE(frame.body_contacts.size() == record->body_contacts().size());
  for (std::size_t c = 0; c < frame.body_contacts.size(); ++c) {
    CHECK(frame.body_contacts[c].force == record->body_contact[c].force);
    CHECK(frame.body_contacts[c].position == record->body_contact[c].position);
  }
}

TEST_CASE("bodies: a stylus that presses on a stack feels all of it", "[slow]") {
  SimulationConfig config = stacked(2, {.cells = 4, .youngs_modulus = 5e3}, {0.6, 0.5});
  config.styluses = {{0.02, 2000.0, 0.0}};
  Simulation simulation(config);
  const double weight = config.objects[0].model->body.mass * kGravity;
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 1500; ++k) step_alone(simulation, *record);
  const double top = record->object[1].position.y() + kHalfEdge;
  StylusCommand command;
  for (int k = 0; k < 2500; ++k) {
    command = at_tip(Vector3(0, top + 0.005 - 0.015 * std::min(1.0, k / 500.0), 0));
    simulation.step({&command, 1}, *record);
  }
  const Vector3 hand = record->stylus[0].force;
  INFO("hand " << hand.transpose() << " N, between the cubes "
               << force_between(*record, 1, 0).transpose() << ", plane "
               << force_between(*record, 0, kFirstScenery).transpose());
  CHECK(hand.y() > 0.5);
  CHECK(force_between(*record, 1, 0).y() == Approx(weight + hand.y()).epsilon(1e-3));
  CHECK(force_between(*record, 0, kFirstScenery).y() ==
        Approx(2 * weight + hand.y()).epsilon(1e-3));
  // Without the coupling spring the tip is where the surface is.
  CHECK((record->stylus[0].proxy - command.tip).norm() ==
        Approx(hand.norm() / 2000.0).epsilon(0.02));
}

TEST_CASE("bodies: those that begin inside one another are refused, by name and depth") {
  SimulationConfig config = stacked(2, {.cells = 3}, {0.5, 0.5});
  config.objects[1].position.y() -= 0.01;
  CHECK_THROWS_WITH(Simulation(config),
                    Catch::Matchers::ContainsSubstring(
                        "object 1 and object 2 are inside one another by 10.0 mm at "
                        "the start") &&
                        Catch::Matchers::ContainsSubstring("apart"));
  config.objects[0].name = "cube";
  CHECK_THROWS_WITH(Simulation(config),
                    Catch::Matchers::ContainsSubstring("object \"cube\" and object 2 are"));
  config.objects[1].name = "lid";
  CHECK_THROWS_WITH(Simulation(config),
                    Catch::Matchers::ContainsSubstring("objects \"cube\" and \"lid\" are inside "
                                                       "one another by 10.0 mm at the start"));
  config.objects[1].position.y() += 0.02;
  config.scenery[0].position.y() = 0.003;
  CHECK_THROWS_WITH(Simulation(config),
                    Catch::Matchers::ContainsSubstring(
                        "object \"cube\" and scenery \"plane\" are inside one another "
                        "by 3.0 mm at the start"));
  config.between_objects = false;
  CHECK_NOTHROW(Simulation(config));
}

TEST_CASE("bodies: those that begin in one place, or nearly, are refused") {
  const double offset = GENERATE(0.0, 1e-4, 4e-4);
  SimulationConfig config = stacked(2, {.cells = 3}, {0.5, 0.5});
  config.objects[1].position = config.objects[0].position + Vector3(0, offset, 0);
  CHECK_THROWS_WITH(Simulation(config), Catch::Matchers::ContainsSubstring(
                                            "object 1 and object 2 are inside one another"));
  config.between_objects = false;
  CHECK_NOTHROW(Simulation(config));
}

// Where the edge passes the middle of a post, the post's normal is that of the face beside it.
TEST_CASE("body contacts: edges of a cube that is pushed between two posts do not sink into them",
          "[slow]") {
  constexpr double kPostRadius = 0.03;
  constexpr double kPostAside = 0.085;
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fem_cube({.cells = 4, .poisson_ratio = 0.45});
  config.objects[0].position = Vector3(0.1, 0, 0);
  config.objects[0].damping = {20.0, 20.0};
  config.styluses = {{0.02, 2000.0, 0.0}};
  config.scenery.resize(2);
  for (SceneryConfig& post : config.scenery) {
    post.shape = CapsuleShape{kPostRadius, 0.2};
    post.position = Vector3(0, 0, &post == config.scenery.data() ? kPostAside : -kPostAside);
    post.friction = {0.1, 0.1};
  }
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  double deepest = 0.0;
  bool past = false;
  Points u;
  for (int k = 0; k < 1000; ++k) {
    const StylusCommand command = at_tip(Vector3(0.17 - 0.0001 * k, 0, 0));
    simulation.step({&command, 1}, *record);
    const SoftObject& cube = simulation.object();
    cube.engine().displacement(u);
    for (int i = 0; i < cube.model().mesh.surface_node_count(); ++i) {
      const Vector3 node = cube.state().position +
                           cube.state().orientation *
                               (cube.model().mesh.rest_position(i) + Vector3(u.row(i).transpose()));
      for (const double z : {kPostAside, -kPostAside}) {
        deepest = std::max(deepest, kPostRadius - std::hypot(node.x(), node.z() - z));
      }
      past = past || node.x() < -0.01;
    }
  }
  INFO("deepest node " << deepest << " m inside");
  CHECK(past);
  CHECK(deepest < 1e-4);
}
