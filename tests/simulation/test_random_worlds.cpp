// Worlds that nobody thought of: two to eight bodies, soft and rigid, on scenery and among tools.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include "tests/simulation/led_rod.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/simulation/random_numbers.hpp"
#include "tests/simulation/saved_state.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr double kApart = 0.15;    // between the bodies' places at the start [m]
constexpr double kDuration = 3.0;  // [s]
constexpr double kStill = 0.3;     // in which hands wait for their tools [s]

// A stylus that leads its tool to and fro, and turns it.
struct ToolHand {
  ToolHand(Random& random, const Vector3& at) : middle(at) {
    for (Vector3& way : ways) way = anywhere(random, 0.06);
    turns = anywhere(random, 0.4);
    rate = between(random, 1.0, 4.0);
  }
  StylusCommand at(double t) const {
    const double s = rate * std::max(0.0, t - kStill);
    const Vector3 tip = middle + std::sin(s) * ways[0] + (1.0 - std::cos(0.7 * s)) * ways[1];
    return lead_to(tip, rotation_from_vector(std::sin(0.8 * s) * turns));
  }
  Vector3 middle;
  std::array<Vector3, 2> ways;
  Vector3 turns;
  double rate = 0.0;
};

struct World {
  SimulationConfig config;
  std::vector<ToolHand> hands;
  std::string words;
};

// An open box of planes, with a sphere and a capsule in it.
std::vector<SceneryConfig> arena(Random& random) {
  std::vector<SceneryConfig> scenery(4);
  for (SceneryConfig& one : scenery) {
    const double kinetic = between(random, 0.0, 0.8);
    one.friction = {1.2 * kinetic, kinetic};
    one.shape = PlaneShape{};
  }
  scenery[0].position = Vector3(0, -0.2, 0);
  scenery[1].position = Vector3(-0.35, 0, 0);
  scenery[1].orientation = Quaternion::FromTwoVectors(Vector3::UnitY(), Vector3::UnitX());
  scenery[2].shape = SphereShape{between(random, 0.02, 0.06)};
  scenery[2].position = Vector3(between(random, -0.2, 0.2), -0.2, between(random, -0.2, 0.2));
  scenery[3].shape = CapsuleShape{0.02, 0.1};
  scenery[3].position = Vector3(between(random, -0.2, 0.2), -0.19, between(random, -0.2, 0.2));
  scenery[3].orientation = rotation_from_vector(anywhere(random, 1.5));
  return scenery;
}

std::shared_ptr<const Model> rigid_cube(double dt) {
  Model model = made_rigid(*fem_cube({.cells = 3, .dt = dt}));
  model.dt = dt;
  return std::make_shared<const Model>(std::move(model));
}

World make_world(Random& random) {
  World world;
  const double dt = chance(random, 0.5) ? 1e-3 : 2e-3;
  const bool falls = chance(random, 0.6);
  if (falls) world.config.gravity = Vector3(0, -kGravity, 0);
  if (chance(random, 0.7)) world.config.scenery = arena(random);
  const int bodies = std::uniform_int_distribution(2, 8)(random);
  world.config.styluses.clear();
  for (int i = 0; i < bodies; ++i) {
    SimulationObject object;
    const Vector3 place(kApart * (i % 2), kApart * (i / 4), kApart * (i / 2 % 2));
    object.position = place + anywhere(random, 0.01);
    const double kinetic = between(random, 0.0, 0.8);
    object.friction = {kinetic * between(random, 1.0, 1.3), kinetic};
    if (chance(random, 0.25)) {
      object.model = rod(dt);
      const ToolHand hand(random, object.position - Vector3(0, 0.5 * kRodLength, 0));
      SimulationStylus stylus;
      stylus.tool = ToolCoupling{i, {}};
      world.config.styluses.push_back(stylus);
      world.hands.push_back(hand);
    } else {
      const double moduli[] = {1e3, 1e4, 1e5, 1e6};
      const double youngs_modulus = moduli[std::uniform_int_distribution(0, 3)(random)];
      object.model = chance(random, 0.25)
                         ? rigid_cube(dt)
                         : fem_cube({.cells = 3, .youngs_modulus = youngs_modulus, .dt = dt});
      object.velocity = 0.3 * (Vector3(0.5, 0.5, 0.5) * kApart - place) / kApart;
    }
    world.config.objects.push_back(object);
  }
  if (world.config.styluses.empty()) world.config.styluses.resize(1);
  world.words = std::to_string(bodies) + " bodies, " + std::to_string(world.hands.size()) +
                " tools, scenery " + std::to_string(world.config.scenery.size()) + ", gravity " +
                std::to_string(falls) + ", dt " + std::to_string(dt);
  return world;
}

struct Outcome {
  bool finite = true;
  double residual = 0.0;
  int unsolved = 0;
  double excess = 0.0;    // most energy there was beyond what was put in [J]
  double gross = 0.0;     // put in by the styluses, and there at first [J]
  double momentum = 0.0;  // largest error of a body in a step [N s]
  int contacts = 0;
  std::vector<RigidState> last;
};

double energy(const Simulation& simulation, const World& world, const std::vector<ToolLead>& tools,
              const std::vector<StylusCommand>& commands) {
  double sum = 0.0;
  for (int i = 0; i < simulation.object_count(); ++i) {
    const SoftObject& object = simulation.object(i);
    FreeForces free;
    free.gravity = world.config.gravity;
    sum += rigid_energy(object.rigid(), free, object.state());
  }
  for (std::size_t s = 0; s < tools.size(); ++s) {
    const RigidState& state = simulation.object(tools[s].object()).state();
    const CouplingHome home{commands[s].tip, commands[s].orientation};
    sum += tools[s].coupling().energy(home, state.position, state.orientation);
  }
  return sum;
}

// M dv - dt (gravity and contacts) of a body that is no tool [N s].
double momentum_error(const World& world, const StepRecord& record, int body,
                      const RigidState& before, const RigidState& now, double dt) {
  const SimulationObject& object = world.config.objects[static_cast<std::size_t>(body)];
  Vector3 force = object.model->body.mass * world.config.gravity;
  for (const BodyContactRecord& contact : record.body_contacts()) {
    if (contact.object == body) force += contact.force;
    if (contact.other == body) force -= contact.force;
  }
  return (object.model->body.mass * (now.velocity - before.velocity) - dt * force).norm();
}

Outcome play(const World& world) {
  Simulation simulation(world.config);
  const double dt = simulation.dt();
  const auto record = std::make_unique<StepRecord>();
  std::vector<ToolLead> tools;
  std::vector<bool> led(world.config.objects.size(), false);
  for (const SimulationStylus& stylus : world.config.styluses) {
    if (!stylus.tool) continue;
    const auto object = static_cast<std::size_t>(stylus.tool->object);
    tools.emplace_back(*stylus.tool, world.config.objects[object], "tool");
    led[object] = true;
  }
  std::vector<StylusCommand> commands(world.config.styluses.size());
  for (std::size_t s = 0; s < world.hands.size(); ++s) commands[s] = world.hands[s].at(0.0);
  Outcome outcome;
  const double begun = energy(simulation, world, tools, commands);
  for (int i = 0; i < simulation.object_count(); ++i) {
    outcome.gross += rigid_energy(simulation.object(i).rigid(), {}, simulation.object(i).state());
    outcome.last.push_back(simulation.object(i).state());
  }
  double work = 0.0;
  for (int k = 1; k * dt <= kDuration; ++k) {
    const std::vector<StylusCommand> before = commands;
    for (std::size_t s = 0; s < world.hands.size(); ++s) commands[s] = world.hands[s].at(k * dt);
    simulation.step(commands, *record);
    for (std::size_t s = 0; s < world.hands.size(); ++s) {
      const Quaternion turn = commands[s].orientation * before[s].orientation.conjugate();
      const double done = -record->stylus[s].force.dot(commands[s].tip - before[s].tip) -
                          record->stylus[s].torque.dot(rotation_vector(turn));
      work += done;
      outcome.gross += std::max(0.0, done);
    }
    for (int i = 0; i < simulation.object_count(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      const RigidState& now = simulation.object(i).state();
      outcome.finite = outcome.finite && now.position.allFinite() && now.velocity.allFinite() &&
                       now.angular_momentum.allFinite();
      outcome.residual = std::max(outcome.residual, record->object[index].residual);
      outcome.unsolved += record->object[index].solved ? 0 : 1;
      if (!led[index]) {
        outcome.momentum = std::max(
            outcome.momentum, momentum_error(world, *record, i, outcome.last[index], now, dt));
      }
      outcome.last[index] = now;
    }
    outcome.contacts += static_cast<int>(record->body_contact.size());
    const double there = energy(simulation, world, tools, commands);
    outcome.excess = std::max(outcome.excess, there - begun - work);
  }
  return outcome;
}

// @param exempt worlds in which a contact may gain energy, as processors round differently and a
// world goes another way then: a sample that comes into another body from beside an edge is pushed
// out again, which does work
void check_worlds(unsigned count, unsigned exempt) {
  double worst = 0.0;
  unsigned gaining = 0;
  unsigned without_solution = 0;
  double residual = 0.0;
  int unsolved = 0;
  unsigned touched = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    Random random(seed);
    const World world = make_world(random);
    const Outcome outcome = play(world);
    INFO("seed " << seed << ": " << world.words << "; " << outcome.excess << " J too much of "
                 << outcome.gross << " J, residual " << outcome.residual << " m, unsolved "
                 << outcome.unsolved << ", momentum off by " << outcome.momentum << " N s");
    CHECK(outcome.finite);
    CHECK(outcome.residual <= 1e-3);
    CHECK(outcome.momentum < 1e-10);
    CHECK(outcome.excess <= 5e-3);
    gaining += outcome.excess > 0.01 * outcome.gross ? 1 : 0;
    without_solution += outcome.unsolved > 0 ? 1 : 0;
    if (seed % 10 == 0) {
      const Outcome again = play(world);
      for (std::size_t i = 0; i < again.last.size(); ++i) {
        CHECK(again.last[i].position == outcome.last[i].position);
        CHECK(again.last[i].angular_momentum == outcome.last[i].angular_momentum);
      }
    }
    touched += outcome.contacts > 0 ? 1 : 0;
    unsolved += outcome.unsolved;
    worst = std::max(worst, outcome.excess / outcome.gross);
    residual = std::max(residual, outcome.residual);
  }
  CHECK(10 * touched > 8 * count);
  CHECK(gaining <= exempt);
  CHECK(without_solution == 0);
  std::cout << count << " random worlds: at most " << 100 * worst
            << " % energy too much, residual at most " << residual << " m, " << unsolved
            << " steps without a solution; more than 1 % in " << gaining << " worlds\n";
}

}  // namespace

TEST_CASE("random worlds: finite, in balance, and no energy from nowhere", "[slow]") {
  check_worlds(10, 0);
}

TEST_CASE("random worlds: the same for sixty", "[exhaustive]") {
  check_worlds(60, 1);
}

TEST_CASE("random worlds: a state that was saved goes on to the same bits", "[slow]") {
  for (unsigned seed = 0; seed < 6; ++seed) {
    Random random(seed);
    const World world = make_world(random);
    const double dt = world.config.objects[0].model->dt;
    INFO("seed " << seed << ": " << world.words);
    const auto commands = [&](int k) {
      std::vector<StylusCommand> all(world.config.styluses.size());
      for (std::size_t s = 0; s < world.hands.size(); ++s) all[s] = world.hands[s].at(k * dt);
      return all;
    };
    check_saved_state(world.config, 300 + 50 * static_cast<int>(seed), 200, commands);
  }
}
