// A hundred scenes that nobody thought of.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

#include "tests/simulation/pressed_cube.hpp"
#include "tests/simulation/random_numbers.hpp"
#include "tests/simulation/saved_state.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

// A tip that goes to and fro through a place, and takes hold from time to time.
struct Hand {
  Hand(Random& random, const Vector3& about) : middle(about + anywhere(random, 0.05)) {
    for (std::size_t i = 0; i < waves.size(); ++i) {
      waves[i] = {anywhere(random, 0.05), between(random, 0.5, 4.0), between(random, 0.0, 6.0)};
    }
    holds = chance(random, 0.5) ? between(random, 0.3, 1.5) : 0.0;
  }
  StylusCommand at(double t) const {
    Vector3 tip = middle;
    for (const Wave& wave : waves) tip += std::sin(wave.rate * t + wave.phase) * wave.size;
    tip.y() = std::max(tip.y(), lowest);
    const bool grab = holds > 0.0 && std::fmod(t, 2.0 * holds) > holds;
    return {true, grab ? kGrabButton : 0u, tip, std::nullopt};
  }
  struct Wave {
    Vector3 size;
    double rate, phase;
  };
  Vector3 middle;
  std::array<Wave, 3> waves;
  double lowest = -1.0;  // a hand does not go through the floor
  double holds = 0.0;
};

struct Scene {
  SimulationConfig config;
  std::vector<Hand> hands;
};

// Soft to far too stiff for the step.
double any_stiffness(Random& random) {
  return 1e3 * std::pow(1e3, between(random, 0.0, 1.0));
}

Scene make_scene(Random& random) {
  Scene scene;
  const double dt = chance(random, 0.5) ? 1e-3 : 2e-3;
  const bool floor = chance(random, 0.4);
  if (floor) {
    scene.config.gravity = Vector3(0, -9.81, 0);
    const double kinetic = between(random, 0.0, 0.8);
    scene.config.floor =
        FloorConfig{Vector3(0, 1, 0), -kHalfEdge - 0.002, {1.2 * kinetic, kinetic}};
  }
  const int objects = std::uniform_int_distribution(1, 3)(random);
  for (int i = 0; i < objects; ++i) {
    SimulationObject object;
    object.model = fem_cube({.cells = 3, .youngs_modulus = any_stiffness(random), .dt = dt});
    object.position = Vector3(0.2 * i, 0.0, 0.0);
    const double kinetic = between(random, 0.0, 1.0);
    object.friction = {kinetic * between(random, 1.0, 1.3), kinetic};
    if (chance(random, 0.3)) object.damping = {between(random, 0.0, 10.0), 5.0};
    if (chance(random, 0.5)) object.tether = {between(random, 1.0, 8.0), 0.02};
    if (!floor) object.angular_velocity = anywhere(random, 2.0);
    scene.config.objects.push_back(object);
  }
  const int styluses = std::uniform_int_distribution(1, 2)(random);
  scene.config.styluses.clear();
  for (int s = 0; s < styluses; ++s) {
    const double radius = chance(random, 0.4) ? 0.0 : between(random, 0.003, 0.025);
    const double coupling = chance(random, 0.4) ? 0.0 : between(random, 300.0, 2000.0);
    scene.config.styluses.push_back({radius, coupling, chance(random, 0.3) ? 0.01 : 0.0});
    const int object = std::uniform_int_distribution(0, objects - 1)(random);
    scene.hands.emplace_back(random,
                             scene.config.objects[static_cast<std::size_t>(object)].position);
    // A tip that holds rigidly what lies on the floor leaves nothing to solve.
    const double above = coupling > 0.0 ? 0.005 : 0.03;
    if (floor) scene.hands.back().lowest = scene.config.floor->height + above;
  }
  return scene;
}

// What an object has in its rigid motion, its height and its tether [J].
double energy(const SimulationObject& object, const Vector3& gravity, const ObjectRecord& now) {
  const BodyProperties& body = object.model->body;
  const Vector3 spin = now.orientation.conjugate() * now.angular_velocity;
  const Vector3 away = now.position - object.position;
  const double angle = now.orientation.angularDistance(object.orientation);
  return 0.5 * body.mass * now.velocity.squaredNorm() + 0.5 * spin.dot(body.inertia * spin) -
         body.mass * gravity.dot(now.position) +
         0.5 * object.tether.stiffness * away.squaredNorm() +
         0.5 * object.tether.angular_stiffness * angle * angle;
}

ObjectRecord start_of(const SimulationObject& object) {
  ObjectRecord record;
  record.position = object.position;
  record.orientation = object.orientation;
  record.velocity = object.velocity;
  record.angular_velocity = object.angular_velocity;
  return record;
}

// M dv - dt (forces) of an object without damping and tether, in a step [N s].
// Of all contacts with other bodies [N], W.
Vector3 force_of_bodies(const StepRecord& record, int object) {
  Vector3 sum = Vector3::Zero();
  for (const BodyContactRecord& contact : record.body_contacts()) {
    if (contact.object == object) sum += contact.force;
    if (contact.other == object) sum -= contact.force;
  }
  return sum;
}

double momentum_error(const SimulationObject& object, const SimulationConfig& config,
                      const ObjectRecord& before, const ObjectRecord& now, const Vector3& of_bodies,
                      double dt) {
  Vector3 force = object.model->body.mass * config.gravity + now.floor_force + of_bodies;
  for (const ContactRecord& contact : now.contact) {
    if (contact.state != ContactState::kFree) force += now.halfway * contact.force;
  }
  return (object.model->body.mass * (now.velocity - before.velocity) - dt * force).norm();
}

struct Outcome {
  bool finite = true;
  double residual = 0.0;
  int unsolved = 0;       // steps that were flagged so ...
  bool safe = true;       // ... in which no stylus felt anything
  double excess = 0.0;    // most energy there was beyond what was put in [J]
  double gross = 0.0;     // put in by the styluses, and there at first [J]
  double momentum = 0.0;  // largest error of a step, over the impulse of the weight
  int touched = 0;
};

Outcome play(const Scene& scene, double duration) {
  const SimulationConfig& config = scene.config;
  Simulation simulation(config);
  const double dt = simulation.dt();
  auto record = std::make_unique<StepRecord>();
  std::vector<ObjectRecord> before;
  double there_at_first = 0.0;
  for (const SimulationObject& object : config.objects) {
    before.push_back(start_of(object));
    there_at_first += energy(object, config.gravity, before.back());
  }
  Outcome outcome;
  for (const SimulationObject& object : config.objects) {
    outcome.gross += energy(object, Vector3::Zero(), start_of(object));
  }
  std::vector<StylusCommand> commands(scene.hands.size());
  std::vector<Vector3> last;
  for (const Hand& hand : scene.hands) last.push_back(hand.at(0.0).tip);
  double put_in = 0.0;
  for (int k = 1; k * dt <= duration; ++k) {
    for (std::size_t s = 0; s < commands.size(); ++s) commands[s] = scene.hands[s].at(k * dt);
    simulation.step(commands, *record);
    for (std::size_t s = 0; s < commands.size(); ++s) {
      const double done = -record->stylus[s].force.dot(commands[s].tip - last[s]);
      put_in += done;
      outcome.gross += std::max(0.0, done);
      last[s] = commands[s].tip;
      if (record->stylus[s].contact != ContactState::kFree) ++outcome.touched;
      outcome.finite = outcome.finite && record->stylus[s].force.allFinite();
    }
    double there = 0.0;
    for (std::size_t i = 0; i < config.objects.size(); ++i) {
      const SimulationObject& object = config.objects[i];
      const ObjectRecord& now = record->object[i];
      there += energy(object, config.gravity, now);
      if (now.solved) {
        outcome.residual = std::max(outcome.residual, now.residual);
      } else {
        ++outcome.unsolved;
        for (const ContactRecord& contact : now.contact) {
          outcome.safe = outcome.safe && contact.force.isZero(0.0);
        }
      }
      outcome.finite = outcome.finite && now.position.allFinite() && now.velocity.allFinite() &&
                       now.orientation.coeffs().allFinite() && now.angular_velocity.allFinite();
      if (object.damping.linear == 0.0 && object.tether.stiffness == 0.0) {
        const double impulse = 9.81 * object.model->body.mass * dt;
        outcome.momentum = std::max(
            outcome.momentum, momentum_error(object, config, before[i], now,
                                             force_of_bodies(*record, static_cast<int>(i)), dt) /
                                  impulse);
      }
      before[i] = now;
    }
    outcome.excess = std::max(outcome.excess, there - there_at_first - put_in);
  }
  return outcome;
}

void check_scenes(int count) {
  Random random(11);
  int touched = 0;
  double worst = 0.0;
  double residual = 0.0;
  int unsolved = 0;
  for (int i = 0; i < count; ++i) {
    const Scene scene = make_scene(random);
    const Outcome outcome = play(scene, 10.0);
    INFO("scene " << i << ": " << scene.config.objects.size() << " objects, "
                  << scene.config.styluses.size() << " styluses, floor "
                  << scene.config.floor.has_value() << "; " << outcome.excess << " J too much of "
                  << outcome.gross << " J, residual " << outcome.residual << " m, unsolved "
                  << outcome.unsolved << ", momentum off by " << outcome.momentum);
    CHECK(outcome.finite);
    CHECK(outcome.safe);
    CHECK(outcome.residual <= 1e-4);
    CHECK(outcome.unsolved == 0);
    CHECK(outcome.momentum < 1e-10);
    CHECK(outcome.excess <= 0.01 * outcome.gross);
    unsolved += outcome.unsolved;
    if (outcome.touched > 0) ++touched;
    if (outcome.gross > 0) worst = std::max(worst, outcome.excess / outcome.gross);
    residual = std::max(residual, outcome.residual);
  }
  CHECK(5 * touched > 4 * count);
  std::cout << count << " random scenes: at most " << 100 * worst
            << " % energy too much, residual at most " << residual << " m, " << unsolved
            << " steps without a solution\n";
}

}  // namespace

TEST_CASE("random scenes: finite, in balance, and no energy from nowhere", "[slow]") {
  check_scenes(12);
}

TEST_CASE("random scenes: the same for sixty", "[exhaustive]") {
  check_scenes(60);
}

TEST_CASE("random scenes: a state that was saved goes on to the same bits", "[slow]") {
  Random random(12);
  for (int i = 0; i < 8; ++i) {
    const Scene scene = make_scene(random);
    const double dt = scene.config.objects[0].model->dt;
    INFO("scene " << i);
    const auto commands = [&](int k) {
      std::vector<StylusCommand> all;
      for (const Hand& hand : scene.hands) all.push_back(hand.at(k * dt));
      return all;
    };
    check_saved_state(scene.config, 100 + 40 * i, 200, commands);
  }
}
