// Bodies that a stylus leads through a coupling of six degrees of freedom.
#include <cmath>
#include <numbers>
#include <random>

#include "common/error.hpp"
#include "tests/simulation/led_rod.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/allocation_guard.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/left_out.hpp"

using Catch::Matchers::ContainsSubstring;
using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kRight = 0.5 * std::numbers::pi;  // [rad]

Quaternion about(const Vector3& axis, double angle) {
  return Quaternion(Eigen::AngleAxisd(angle, axis));
}

Vector3 tip_of(const ObjectRecord& object) {
  return object.position - object.orientation * Vector3(0, 0.5 * kRodLength, 0);
}

// A rod above a soft cube that a tether keeps in place.
SimulationConfig rod_over_cube(double youngs_modulus) {
  SimulationConfig config = led_rod();
  config.objects.resize(2);
  config.objects[1].model = fem_cube({.cells = 4, .youngs_modulus = youngs_modulus});
  config.objects[1].tether = {1000.0, 10.0};
  config.objects[1].damping = {20.0, 20.0};
  for (SimulationObject& object : config.objects) object.friction = {0.6, 0.5};
  config.objects[0].position = Vector3(0.01, kHalfEdge + 0.5 * kRodLength + 0.005, 0.005);
  return config;
}

Vector3 above_cube(double height) {
  return {0.01, kHalfEdge + height, 0.005};
}

}  // namespace

TEST_CASE(
    "tool: one that hangs on its coupling sags by weight / k, and pulls and turns the stylus") {
  CouplingConstants constants;
  constants.stiffness = 150.0;
  constants.angular_stiffness = 0.6;
  SimulationConfig config = led_rod(constants);
  config.gravity = Vector3(0, -kGravity, 0);
  config.objects[0].orientation = about(Vector3::UnitZ(), -kRight);  // lies along x
  config.objects[0].position = Vector3(0.5 * kRodLength, 0, 0);
  Simulation simulation(config);
  StepRecord record;
  const StylusCommand command = lead_to(Vector3::Zero());
  for (int k = 0; k < 4000; ++k) simulation.step({&command, 1}, record);
  const Vector3 weight = kRodMass * config.gravity;
  const StylusRecord& stylus = record.stylus[0];
  const Vector3 lever = record.object[0].position - tip_of(record.object[0]);
  CHECK(stylus.tool == 0);
  CHECK((stylus.force - weight).norm() < 1e-9);
  CHECK((stylus.torque - lever.cross(weight)).norm() < 1e-9);
  CHECK((tip_of(record.object[0]) - weight / 150.0).norm() < 1e-9);
  CHECK((stylus.proxy - tip_of(record.object[0])).norm() < 1e-12);
  const Vector3 turn =
      rotation_vector(record.object[0].orientation * config.objects[0].orientation.conjugate());
  CHECK((0.6 * turn - stylus.torque).norm() < 1e-9);
}

TEST_CASE("tool: it oscillates as a mass on a spring and damper, of second order in dt") {
  const double m = kRodMass;
  const auto worst = [&](double dt, bool turning) {
    Model model = *rod(dt);
    model.mesh.com_offset.setZero();
    const double inertia = model.body.inertia(0, 0);
    const double w = 40.0;
    const double zeta = 0.4;
    CouplingConstants constants;
    constants.stiffness = w * w * m;
    constants.damping = 2.0 * zeta * w * m;
    constants.angular_stiffness = w * w * inertia;
    constants.angular_damping = 2.0 * zeta * w * inertia;
    SimulationConfig config = led_rod(constants, dt);
    config.objects[0].model = std::make_shared<const Model>(std::move(model));
    config.objects[0].position.setZero();
    config.objects[0].velocity = turning ? Vector3::Zero() : Vector3(0.1, 0, 0);
    config.objects[0].angular_velocity = turning ? Vector3(2.0, 0, 0) : Vector3::Zero();
    Simulation simulation(config);
    StepRecord record;
    const StylusCommand nobody;  // the home stays
    const double damped = w * std::sqrt(1.0 - zeta * zeta);
    double largest = 0.0;
    const int steps = static_cast<int>(std::lround(0.2 / dt));
    for (int k = 0; k < steps; ++k) {
      simulation.step({&nobody, 1}, record);
      const double t = record.time;
      const double unit = std::exp(-zeta * w * t) * std::sin(damped * t) / damped;
      const double found = turning ? rotation_vector(record.object[0].orientation).x() / 2.0
                                   : record.object[0].position.x() / 0.1;
      largest = std::max(largest, std::abs(found - unit));
    }
    return largest * damped;  // as a part of the amplitude
  };
  for (const bool turning : {false, true}) {
    const double coarse = worst(0.002, turning);
    const double fine = worst(0.001, turning);
    INFO("turning " << turning << ": off by " << coarse << " at 2 ms, " << fine << " at 1 ms");
    CHECK(coarse < 2e-3);
    CHECK(coarse / fine > 3.7);
    CHECK(coarse / fine < 4.3);
  }
}

TEST_CASE(
    "tool: the energy on a coupling that is hardly damped does not grow, however far it turns") {
  const BodyProperties body = rod()->body;
  const Vector3 tip(0, -0.5 * kRodLength, 0);
  const RigidBody rigid(body, 0.002);
  const double share = GENERATE(0.1, 0.3, 0.55);
  CouplingConstants constants{
      0.7 * share * 0.25 * kRodMass / 4e-6, {}, 0.2 * share * body.inertia(0, 0) / 4e-6, {}};
  constants = default_coupling(body, tip, 0.002, constants);
  *constants.damping *= 0.301;
  *constants.angular_damping *= 0.301;
  const PoseCoupling coupling(body, tip, constants, 0.002, "tool");
  const CouplingStep led{&coupling, {tip, Quaternion::Identity()}};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return Vector3(uniform(random), uniform(random), uniform(random)); };
  double most = 0.0;
  double left = 0.0;
  for (const double far : {0.05, 0.2, 0.5, 1.0}) {
    for (int trial = 0; trial < 10; ++trial) {
      RigidState state;
      state.position = 0.02 * far * vector();
      state.orientation = rotation_from_vector(far * vector());
      state.velocity = 0.4 * far * vector();
      state.angular_momentum = rigid.angular_momentum(state.orientation, 6.0 * far * vector());
      const auto energy = [&] {
        return rigid_energy(rigid, {}, state) +
               coupling.energy(led.home, state.position, state.orientation);
      };
      const double begun = energy();
      for (int k = 0; k < 1000; ++k) {
        const FreeMotion motion = free_motion(rigid, {}, state, led);
        state = end_of_step(rigid, {}, motion, Vector3::Zero(), Vector3::Zero(), led).state;
        most = std::max(most, energy() / begun);
      }
      left = std::max(left, energy() / begun);
    }
  }
  INFO("w dt " << 0.002 * coupling.highest_frequency() << ": at most " << most
               << " of the energy that it began with, after 2 s " << left);
  CHECK(most < 1.05);
  CHECK(left < 1e-6);
}

TEST_CASE("tool: a led motion is of second order in dt") {
  const auto poses = [](double dt) {
    const CouplingConstants constants{150.0, 2.0, 0.6, 0.006};
    SimulationConfig config = led_rod(constants, dt);
    config.gravity = Vector3(0, -kGravity, 0);
    Simulation simulation(config);
    StepRecord record;
    std::vector<RigidState> kept;
    const int steps = static_cast<int>(std::lround(1.0 / dt));
    for (int k = 0; k < steps; ++k) {
      // It has arrived from the first step on: its speed starts at 0.
      const double t = (k + 1) * dt;
      const double way = 1.0 - std::cos(4.0 * t);
      const StylusCommand command =
          lead_to(0.02 * way * Vector3(1, 0.5, -0.3),
                  rotation_from_vector(0.3 * way * Vector3(0.2, 1.0, 0.5)));
      simulation.step({&command, 1}, record);
      if ((k + 1) % (steps / 50) == 0) kept.push_back(simulation.object().state());
    }
    return kept;
  };
  const std::vector<RigidState> exact = poses(0.000125);
  const auto off = [&](double dt) {
    const std::vector<RigidState> found = poses(dt);
    double largest = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const Vector3 turn = rotation_vector(found[i].orientation * exact[i].orientation.conjugate());
      largest =
          std::max(largest, (found[i].position - exact[i].position).norm() + 0.1 * turn.norm());
    }
    return largest;
  };
  const double coarse = off(0.001);
  const double fine = off(0.0005);
  INFO("off by at most " << coarse << " m at 1 ms, " << fine << " m at 0.5 ms");
  CHECK(coarse < 1e-5);
  CHECK(coarse / fine > 3.5);
}

TEST_CASE("tool: pressed on a soft cube, its stylus gets what the contacts exert, and their moment",
          "[slow]") {
  const double youngs_modulus = GENERATE(2e3, 1e5);
  const SimulationConfig config = rod_over_cube(youngs_modulus);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  RigidState before;
  for (int k = 0; k < 15'000; ++k) {
    const double s = std::min(1.0, k / 1000.0);
    // A little aslant: there is a moment about the tip.
    const StylusCommand command =
        lead_to(above_cube(0.005 - 0.02 * s), about(Vector3::UnitZ(), 0.1 * s));
    before = simulation.object(0).state();
    simulation.step({&command, 1}, *record);
  }
  Vector3 force = Vector3::Zero();
  Vector3 moment = Vector3::Zero();
  const Vector3 tip = tip_of(record->object[0]);
  for (const BodyContactRecord& contact : record->body_contacts()) {
    const Vector3 one = contact.object == 0 ? contact.force : Vector3(-contact.force);
    force += one;
    moment += (contact.position - tip).cross(one);
  }
  const StylusRecord& stylus = record->stylus[0];
  const RigidState& now = simulation.object(0).state();
  const Vector3 gained = kRodMass / 0.002 * (now.velocity - before.velocity);
  const double off = (stylus.force - force + gained).norm();
  const double off_at_rest = (stylus.force - force).norm();
  const double moment_off = (stylus.torque - moment).norm();
  INFO("E " << youngs_modulus << ": force " << stylus.force.transpose() << " N, torque "
            << stylus.torque.transpose() << " N m; in the step the balance is off by " << off
            << " N, as if at rest by " << off_at_rest << " N and " << moment_off
            << " N m; the rod moves at " << now.velocity.norm() << " m/s");
  CHECK(stylus.force.y() > 0.2);
  CHECK(stylus.contact == ContactState::kFree);
  CHECK(stylus.object == -1);
  CHECK(off < 1e-9);
  CHECK(off_at_rest < 1e-4 * stylus.force.y());
  CHECK(moment_off < 1e-3 * stylus.torque.norm());
}

TEST_CASE("tool: pressed on a plane it comes to it, however light it is") {
  SimulationConfig config = led_rod();
  config.scenery.resize(1);
  config.scenery[0].shape = PlaneShape{};
  config.scenery[0].friction = {0.5, 0.5};
  config.objects[0].position.y() += 0.005;
  Simulation simulation(config);
  StepRecord record;
  double deepest = 0.0;
  for (int k = 0; k < 1500; ++k) {
    const StylusCommand command = lead_to(Vector3(0, 0.005 - 0.02 * std::min(1.0, k / 500.0), 0));
    simulation.step({&command, 1}, record);
    deepest = std::max(deepest, -tip_of(record.object[0]).y());
  }
  const double height = tip_of(record.object[0]).y();
  INFO("pressed with " << record.stylus[0].force.y() << " N it ends at " << height
                       << " m, at the deepest " << -deepest << " m");
  CHECK(record.stylus[0].force.y() > 1.5);
  CHECK(std::abs(height) < 1e-6);
  CHECK(deepest < 1e-5);
}

TEST_CASE("tool: what it stores is never more than what its hand put in, poked at random",
          "[slow]") {
  const double youngs_modulus = GENERATE(1e3, 1e4, 1e5, 1e6);
  const SimulationConfig config = rod_over_cube(youngs_modulus);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  const ToolLead lead(*config.styluses[0].tool, config.objects[0], "tool");
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  StylusCommand command = lead_to(above_cube(0.005));
  for (int k = 0; k < 100; ++k) simulation.step({&command, 1}, *record);
  Vector3 target = command.tip;
  Vector3 turn = Vector3::Zero();
  Vector3 turn_target = Vector3::Zero();
  double work = 0.0;
  double largest = 0.0;
  double worst = -1.0;
  const auto energy = [&] {
    double sum = 0.0;
    for (int i = 0; i < 2; ++i) {
      const SoftObject& object = simulation.object(i);
      const SimulationObject& start = config.objects[static_cast<std::size_t>(i)];
      FreeForces free;
      free.tether = start.tether;
      free.home_position = start.position;
      sum += rigid_energy(RigidBody(object.model().body, 0.002), free, object.state());
    }
    const CouplingHome home{command.tip, command.orientation};
    const RigidState& rod_state = simulation.object(0).state();
    return sum + lead.coupling().energy(home, rod_state.position, rod_state.orientation);
  };
  const double begun = energy();
  int touching = 0;
  for (int k = 0; k < 15'000; ++k) {
    if (k % 100 == 0 && k < 10'000) {
      target = above_cube(0.0) + Vector3(0.03 * uniform(random), 0.02 * uniform(random) - 0.005,
                                         0.03 * uniform(random));
      turn_target = 0.3 * Vector3(uniform(random), uniform(random), uniform(random));
    }
    const Vector3 before = command.tip;
    const Quaternion turned = command.orientation;
    turn += 0.03 * (turn_target - turn);
    command = lead_to(before + 0.03 * (target - before), rotation_from_vector(turn));
    simulation.step({&command, 1}, *record);
    work -= record->stylus[0].force.dot(command.tip - before) +
            record->stylus[0].torque.dot(rotation_vector(command.orientation * turned.conjugate()));
    largest = std::max(largest, energy());
    worst = std::max(worst, energy() - begun - work);
    touching += !record->body_contact.empty() ? 1 : 0;
  }
  INFO("E " << youngs_modulus << ": largest energy " << largest << " J, at most " << worst
            << " J above what was put in, touching in " << touching << " steps, at the end "
            << record->object[0].velocity.norm() << " m/s");
  CHECK(touching > 2000);
  CHECK(worst < 0.01 * largest);
  // On 1e4 N/m^2 it goes on rocking between two of its samples, which slip in turns.
  CHECK(record->object[0].velocity.norm() < (youngs_modulus == 1e4 ? 2e-3 : 1e-5));
}

TEST_CASE("tool: a stylus that appears far from it, or is reset, feels no jump") {
  const bool reset = GENERATE(false, true);
  SimulationConfig config = rod_over_cube(1e4);
  config.gravity = Vector3(0, -kGravity, 0);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  const StylusCommand nobody;
  const double height = config.objects[0].position.y() - 0.5 * kRodLength;
  const Vector3 start(0.01, height, 0.005);
  const Vector3 far = start + Vector3(0.05, 0.05, 0.0);
  const Quaternion turned = about(Vector3::UnitX(), 1.0);
  for (int k = 0; k < 500; ++k) {
    const StylusCommand command = reset ? lead_to(far, turned) : nobody;
    simulation.step({&command, 1}, *record);
  }
  if (!reset) CHECK(record->stylus[0].force.isZero(0.0));
  Vector3 force = Vector3::Zero();
  Vector3 torque = Vector3::Zero();
  double jump = 0.0;
  double turning_jump = 0.0;
  double fastest = 0.0;
  double first_force = -1.0;
  for (int k = 0; k < 500; ++k) {
    const StylusCommand command = lead_to(far, turned);
    simulation.step({&command, 1}, *record, reset && k == 0);
    const StylusRecord& stylus = record->stylus[0];
    if (k > 0) {
      jump = std::max(jump, (stylus.force - force).norm());
      turning_jump = std::max(turning_jump, (stylus.torque - torque).norm());
    }
    force = stylus.force;
    torque = stylus.torque;
    fastest = std::max(fastest, record->object[0].velocity.norm());
    if (first_force < 0.0 && !force.isZero(0.0)) first_force = record->time - (reset ? 1.0 : 1.0);
  }
  INFO("largest step of the force " << jump << " N and " << turning_jump << " N m, rod at most "
                                    << fastest << " m/s, first force after " << first_force
                                    << " s");
  // 0.07 m at 0.5 m/s take 0.14 s, 1 rad at 5 rad/s takes 0.2 s.
  CHECK(first_force > 0.19);
  CHECK(first_force < 0.22);
  CHECK(jump < 0.05);
  CHECK(turning_jump < 0.002);
  CHECK(fastest < 1.0);
  CHECK((force - kRodMass * config.gravity).norm() < 1e-3);
}

TEST_CASE("tool: the stylus that leads one touches nothing by itself") {
  SimulationConfig config = rod_over_cube(1e4);
  config.objects[0].position += Vector3(0.3, 0, 0);
  Simulation simulation(config);
  const auto record = std::make_unique<StepRecord>();
  for (int k = 0; k < 20; ++k) {  // from above into the cube, faster than the rod follows
    const StylusCommand command = lead_to(above_cube(0.01 - 0.001 * k));
    simulation.step({&command, 1}, *record);
  }
  CHECK(record->object[1].contact[0].state == ContactState::kFree);
  CHECK(record->object[1].velocity.isZero(0.0));
  ContactModel model;
  simulation.predict_horizon(0, above_cube(-0.01), 4, model);
  CHECK_FALSE(model.valid);
}

TEST_CASE("tool: while nobody is there the last pose leads it") {
  Simulation simulation(led_rod());
  StepRecord record;
  StylusCommand command = lead_to(Vector3(0.02, 0.01, 0.0), about(Vector3::UnitX(), 0.3));
  for (int k = 0; k < 1000; ++k) simulation.step({&command, 1}, record);
  const Vector3 tip = tip_of(record.object[0]);
  CHECK((tip - command.tip).norm() < 1e-6);
  const StylusCommand nobody;
  command.tip.x() = std::nan("");
  for (int k = 0; k < 1000; ++k) {
    simulation.step({k % 2 == 0 ? &nobody : &command, 1}, record);
    CHECK(record.stylus[0].force.isZero(0.0));
  }
  CHECK((tip_of(record.object[0]) - tip).norm() < 1e-6);
}

TEST_CASE("tool: the same commands give the same bits, again and after a reset", "[unsanitized]") {
  const SimulationConfig config = rod_over_cube(1e4);
  Simulation simulation(config);
  Simulation other(config);
  const auto record = std::make_unique<StepRecord>();
  const auto again = std::make_unique<StepRecord>();
  const auto run = [](Simulation& one, StepRecord& out, int k) {
    const StylusCommand command = lead_to(above_cube(0.005 * std::cos(0.02 * k)),
                                          about(Vector3::UnitX(), 0.1 * std::sin(0.03 * k)));
    one.step({&command, 1}, out, k == 0);
  };
  for (int k = 0; k < 300; ++k) run(other, *again, k);
  for (int k = 0; k < 600; ++k) {
    run(simulation, *record, k);
    run(other, *again, k);
    REQUIRE(record->stylus[0].force == again->stylus[0].force);
    REQUIRE(record->stylus[0].torque == again->stylus[0].torque);
    REQUIRE(record->object[0].position == again->object[0].position);
    REQUIRE(record->object[1].position == again->object[1].position);
  }
}

TEST_CASE("tool: a force that is told of late acts as it would have in time") {
  const PoseCoupling coupling(rod()->body, Vector3(0, -0.5 * kRodLength, 0), {}, 0.002, "tool");
  const RigidBody body(rod()->body, 0.002);
  const FreeForces free{Vector3(0, -kGravity, 0), {1.0, 2.0}, {}, {}, Quaternion::Identity()};
  RigidStateHistory past;
  RigidState state;
  RigidState in_time;
  RigidStateHistory::Forces push;
  push.add(Vector3(0.3, 0.1, -0.2), Vector3(0.01, 0.05, 0.0));
  for (int k = 0; k < 30; ++k) {
    CouplingStep led{&coupling, {}};
    led.home.position = Vector3(0.001 * k, -0.5 * kRodLength, 0);
    led.home.velocity = Vector3(0.5, 0, 0);
    const FreeMotion motion = free_motion(body, free, state, led);
    past.remember(state, motion.halfway, {}, led);
    state = end_of_step(body, free, motion, Vector3::Zero(), Vector3::Zero(), led).state;
    const RigidStateHistory::Forces now = k == 20 ? push : RigidStateHistory::Forces{};
    const FreeMotion moved = free_motion(body, free, in_time, led);
    in_time = end_of_step(body, free, moved, now.sum, now.torque(moved.halfway), led).state;
  }
  past.add(9, Vector3(0.3, 0.1, -0.2), Vector3(0.01, 0.05, 0.0));
  const RigidState replayed = past.replay(body, free, state);
  CHECK(replayed.position == in_time.position);
  CHECK(replayed.velocity == in_time.velocity);
  CHECK(replayed.angular_momentum == in_time.angular_momentum);
}

TEST_CASE("tool: its step allocates nothing, there or not, touching or reset", "[unsanitized]") {
  if (!AllocationGuard::active()) return leave_out(kNotCounted);
  Simulation simulation(rod_over_cube(1e4));
  const auto record = std::make_unique<StepRecord>();
  int touching = 0;
  const AllocationGuard guard;
  for (int k = 0; k < 600; ++k) {
    StylusCommand command = lead_to(above_cube(0.005 - 0.015 * std::sin(0.02 * k)));
    command.present = k % 200 < 150;
    simulation.step({&command, 1}, *record, k == 400);
    touching += !record->body_contact.empty() ? 1 : 0;
  }
  CHECK(guard.count() == 0);
  CHECK(touching > 20);
}
