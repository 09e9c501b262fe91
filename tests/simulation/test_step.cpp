#include "simulation/step/simulation.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "simulation/deformation/deformation.hpp"
#include "simulation/step/nodal_forces.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;
using irdm::test::at_tip;
using irdm::test::fem_cube;
using irdm::test::FemCube;
using irdm::test::kHalfEdge;

namespace {

const Vector3 kUp(0, 1, 0);

// One object that tips stick to, as in the paper.
SimulationConfig one(const std::shared_ptr<const Model>& model) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = model;
  return config;
}

const RigidState& body_of(const Simulation& simulation) {
  return simulation.object().state();
}

using Path = std::function<StylusCommand(double)>;

// Plays a path: step k uses the command at its end, (k + 1) dt.
std::vector<StepRecord> play(Simulation& simulation, const Path& path, int steps) {
  std::vector<StepRecord> records(static_cast<std::size_t>(steps));
  for (int k = 0; k < steps; ++k) {
    const StylusCommand command = path((k + 1) * simulation.dt());
    simulation.step({&command, 1}, records[static_cast<std::size_t>(k)]);
  }
  return records;
}

// Comes down on the top face at 5 cm/s, takes hold of it, and swings it 5 cm at 1.5 Hz from 0.4 s
// on.
StylusCommand swing(double t) {
  const double y = std::max(kHalfEdge + 0.002 - 0.05 * t, kHalfEdge - 0.001);
  const double omega = 2.0 * std::numbers::pi * 1.5;
  const double ramp = std::clamp((t - 0.4) / 0.3, 0.0, 1.0);
  const double x =
      t < 0.4 ? 0.0 : 0.05 * ramp * ramp * (3 - 2 * ramp) * std::sin(omega * (t - 0.4));
  return at_tip({x, y, 0.0}, true);
}

// Taps the side of the cube off its centre, then goes away.
StylusCommand tap(double t) {
  return at_tip(
      {-kHalfEdge - 0.01 + 0.2 * std::min(t, 0.12) - 0.3 * std::max(0.0, t - 0.12), 0.02, 0.01});
}

double largest_force(const std::vector<StepRecord>& records) {
  double largest = 0.0;
  for (const StepRecord& record : records) {
    largest = std::max(largest, record.stylus[0].force.norm());
  }
  return largest;
}

}  // namespace

TEST_CASE("step: an untouched object falls with gravity and spins on", "[unsanitized]") {
  const auto model = fem_cube({});
  SimulationConfig config = one(model);
  config.gravity = Vector3(0, -9.81, 0);
  config.objects[0].angular_velocity = Vector3(1, 2, 3);
  Simulation simulation(config);
  const auto records = play(
      simulation, [](double) { return StylusCommand{}; }, 500);
  const StepRecord& end = records.back();
  const ObjectRecord& last = end.object[0];
  CHECK((last.velocity - Vector3(0, -9.81, 0)).norm() < 1e-12);
  CHECK(last.position.y() == Approx(-0.5 * 9.81 * 1.0).epsilon(1e-12));
  CHECK(end.time == Approx(1.0));
  CHECK(end.stylus[0].contact == ContactState::kFree);
  Points u;
  simulation.object().engine().displacement(u);
  CHECK(u.norm() == 0.0);
}

TEST_CASE("step: a held node follows a swung stylus within 0.5 mm, with a smooth force", "[slow]") {
  for (const double youngs_modulus : {2000.0, 20000.0}) {
    for (const double dt : {0.002, 0.001}) {
      FemCube cube;
      cube.youngs_modulus = youngs_modulus;
      cube.dt = dt;
      const auto model = fem_cube(cube);
      Simulation simulation(one(model));
      const int steps = static_cast<int>(std::lround(3.0 / dt));
      const auto records = play(simulation, swing, steps);
      const double peak = largest_force(records);
      double distance = 0.0;
      double alternation = 0.0;
      for (std::size_t k = 0; k < records.size(); ++k) {
        const StylusRecord& now = records[k].stylus[0];
        if (now.contact != ContactState::kHeld) continue;
        distance = std::max(distance, (now.proxy - now.tip).norm());
        if (records[k].time < 0.41) continue;  // past the moment of taking hold
        // Alternation: how far a step's force is from the mean of its neighbours.
        if (k + 1 < records.size()) {
          const Vector3 mean =
              0.5 * (records[k - 1].stylus[0].force + records[k + 1].stylus[0].force);
          alternation = std::max(alternation, (now.force - mean).norm());
        }
      }
      INFO("E = " << youngs_modulus << ", dt = " << dt << ": peak " << peak << " N, distance "
                  << distance << " m, alternation " << alternation << " N");
      CHECK(records.back().stylus[0].contact == ContactState::kHeld);
      CHECK(peak > 0.5);
      CHECK(distance < 0.5e-3);
      CHECK(alternation < 0.02 * peak);
    }
  }
}

TEST_CASE("step: momentum and angular momentum change exactly by the impulses of the contacts",
          "[unsanitized]") {
  const auto model = fem_cube({});
  for (const Path& path : {Path(swing), Path(tap)}) {
    Simulation simulation(one(model));
    const RigidBody body(model->body, model->dt);
    // An engine of the test's own gives the deformed lever arms.
    const auto engine = make_engine(model);
    const RestSurface surface(model->mesh);
    RecordedForces forces(one(model), 0, surface);
    Vector3 momentum = Vector3::Zero();
    Vector3 angular = Vector3::Zero();
    double impulses = 0.0;
    double angular_impulses = 0.0;
    double worst = 0.0;
    double worst_angular = 0.0;
    StepRecord record;
    for (int k = 0; k < 10'000; ++k) {
      const StylusCommand command = path((k + 1) * simulation.dt());
      simulation.step({&command, 1}, record);
      const StylusRecord& stylus = record.stylus[0];
      const Quaternion& Q = record.object[0].halfway;
      if (stylus.contact != ContactState::kFree) {
        const Vector3 arm =
            interpolate(record.object[0].contact[0].point,
                        [&](int i) -> Vector3 {
                          return model->mesh.rest_position(i) + engine->free_displacement(i);
                        }) +
            record.object[0].contact[0].arm_shift;
        const Vector3 impulse = -model->dt * stylus.force;
        momentum += impulse;
        angular += (Q * arm).cross(impulse);
        impulses += impulse.norm();
        angular_impulses += (Q * arm).cross(impulse).norm();
      }
      engine->advance(forces.of(record.object[0], {}));
      const Vector3 L =
          body.angular_momentum(record.object[0].orientation, record.object[0].angular_velocity);
      worst = std::max(worst, (model->body.mass * record.object[0].velocity - momentum).norm());
      worst_angular = std::max(worst_angular, (L - angular).norm());
    }
    CHECK(impulses > 1e-3);
    CHECK(worst < 1e-10 * impulses);
    CHECK(worst_angular < 1e-10 * angular_impulses);
  }
}

// A force that is held over the step acts where the point is meanwhile, not where it ends.
TEST_CASE("step: the lever arm of a held point is that of its mean place over the step") {
  const auto model = fem_cube({});
  Simulation simulation(one(model));
  const auto engine = make_engine(model);
  const RestSurface surface(model->mesh);
  RecordedForces forces(one(model), 0, surface);
  Points before;
  Points after;
  StepRecord record;
  bool held = false;
  int steps = 0;
  double largest = 0.0;
  for (int k = 0; k < 500; ++k) {
    const StylusCommand command = swing((k + 1) * simulation.dt());
    simulation.step({&command, 1}, record);
    const ContactRecord& contact = record.object[0].contact[0];
    Points free(model->mesh.surface_node_count(), 3);
    for (int i = 0; i < model->mesh.surface_node_count(); ++i) {
      free.row(i) = engine->free_displacement(i);
    }
    engine->displacement(before);
    engine->advance(forces.of(record.object[0], {}));
    engine->displacement(after);
    const bool was_held = std::exchange(held, contact.state == ContactState::kHeld);
    if (!held) continue;
    const Points shift = 0.5 * ((was_held ? before : free) + after) - free;
    const Vector3 expected =
        interpolate(contact.point, [&](int i) -> Vector3 { return shift.row(i).transpose(); });
    CHECK((contact.arm_shift - expected).norm() < 1e-14);
    largest = std::max(largest, expected.norm());
    ++steps;
  }
  CHECK(steps > 400);
  CHECK(largest > 1e-5);
}

TEST_CASE("step: a tap touches, pushes only, lets go, and leaves the cube moving and ringing",
          "[unsanitized]") {
  const auto model = fem_cube({});
  Simulation simulation(one(model));
  // A micrometre further off, so that the surface is not reached at the very end of a step.
  const auto later = [](double t) {
    StylusCommand command = tap(t);
    command.tip.x() -= 1e-6;
    return command;
  };
  const auto records = play(simulation, later, 400);
  int touched = 0;
  int first = -1;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const StylusRecord& stylus = records[k].stylus[0];
    if (stylus.contact == ContactState::kFree) {
      REQUIRE(stylus.force == Vector3::Zero());
      REQUIRE(stylus.proxy == stylus.tip);
      continue;
    }
    if (first < 0) first = static_cast<int>(k);
    ++touched;
    REQUIRE(stylus.contact == ContactState::kTouching);
    REQUIRE(stylus.force.x() <
            0);  // outward on the left face, as long as the cube has hardly turned
    REQUIRE((stylus.proxy - stylus.tip).norm() < 1e-5);
  }
  CHECK(first == 25);  // 1 cm at 0.2 m/s is reached at 50 ms
  CHECK(touched > 5);
  CHECK(records.back().stylus[0].contact == ContactState::kFree);
  CHECK(records.back().object[0].velocity.x() > 0.05);
  CHECK(records.back().object[0].angular_velocity.norm() > 0.1);
  Points u;
  simulation.object().engine().displacement(u);
  CHECK(u.cwiseAbs().maxCoeff() > 1e-6);
}

TEST_CASE("step: a tip that was never outside makes no contact") {
  const auto model = fem_cube({});
  const Vector3 just_inside(0.01, kHalfEdge - 0.0005, 0.005);
  // In the middle; so near the surface that a contact might begin there; so fast that it might have
  // come from outside in the step.
  const std::vector<Path> ways{
      [](double t) {
        return at_tip({0.01 * t, 0, 0});
      },
      [&](double t) { return at_tip(just_inside + 4e-4 * std::sin(50.0 * t) * kUp); },
      [&](double t) { return at_tip(std::cos(1000.0 * t) * just_inside); },
  };
  for (std::size_t i = 0; i < ways.size(); ++i) {
    CAPTURE(i);
    Simulation simulation(one(model));
    for (const StepRecord& record : play(simulation, ways[i], 100)) {
      REQUIRE(record.stylus[0].contact == ContactState::kFree);
      REQUIRE(record.stylus[0].force == Vector3::Zero());
    }
    // Once it has been outside it does.
    play(
        simulation, [&](double) { return at_tip(just_inside + 0.001 * kUp); }, 1);
    const auto back = play(
        simulation, [&](double) { return at_tip(just_inside); }, 1);
    CHECK(back[0].stylus[0].contact == ContactState::kTouching);
    CHECK(back[0].stylus[0].force.y() > 0.0);
  }
}

TEST_CASE("step: letting go of a held point makes no jump while the stylus still pushes") {
  const auto model = fem_cube({});
  Simulation simulation(one(model));
  // Pushed along with 3 m/s^2, so that it presses all the time; held between 0.2 s and 0.3 s.
  const auto records = play(
      simulation,
      [](double t) {
        return at_tip(Vector3(0, kHalfEdge + 0.0005 - 0.02 * t - 1.5 * t * t, 0),
                      t > 0.2 && t < 0.3);
      },
      200);
  int changes = 0;
  for (std::size_t k = 2; k < records.size(); ++k) {
    const StylusRecord& before = records[k - 1].stylus[0];
    const StylusRecord& now = records[k].stylus[0];
    if (before.contact == ContactState::kFree || before.contact == now.contact) continue;
    ++changes;
    // No jump: the force goes on in the direction in which it was changing.
    const Vector3 expected = 2.0 * before.force - records[k - 2].stylus[0].force;
    CHECK((now.force - expected).norm() < 0.005 * largest_force(records));
  }
  CHECK(changes == 2);
  CHECK(records[120].stylus[0].contact == ContactState::kHeld);
  CHECK(records[199].stylus[0].contact == ContactState::kTouching);
}

TEST_CASE("step: a stylus that goes absent ends its contact") {
  Simulation simulation(one(fem_cube({})));
  auto records = play(simulation, swing, 300);
  REQUIRE(records.back().stylus[0].contact == ContactState::kHeld);
  records = play(
      simulation, [](double) { return StylusCommand{}; }, 1);
  CHECK(records.back().stylus[0].contact == ContactState::kFree);
  CHECK(records.back().stylus[0].force == Vector3::Zero());
  // Back inside the object it touches nothing.
  records = play(
      simulation,
      [](double) {
        return at_tip({0, 0.05, 0}, true);
      },
      1);
  CHECK(records.back().stylus[0].contact == ContactState::kFree);
}

TEST_CASE("step: input that is not finite is nobody's stylus") {
  Simulation simulation(one(fem_cube({})));
  play(simulation, swing, 300);
  const auto records = play(
      simulation, [](double) { return at_tip(Vector3(0, std::nan(""), 0), true); }, 5);
  CHECK(largest_force(records) == 0.0);
  CHECK(records.back().object[0].position.allFinite());
}

TEST_CASE("step: a force given by the bridge does what the same force found by the step does") {
  const auto model = fem_cube({});
  Simulation solving(one(model));
  Simulation given(one(model));
  StepRecord found, repeated;
  for (int k = 0; k < 1000; ++k) {
    StylusCommand command = swing((k + 1) * model->dt);
    solving.step({&command, 1}, found);
    const StylusRecord& stylus = found.stylus[0];
    if (stylus.contact != ContactState::kFree) {
      command.given =
          GivenForce{stylus.contact, found.object[0].contact[0].point, -stylus.force, 0};
    } else {
      command.present = false;
    }
    given.step({&command, 1}, repeated);
    REQUIRE((repeated.object[0].position - found.object[0].position).norm() < 1e-12);
    REQUIRE(repeated.object[0].orientation.angularDistance(found.object[0].orientation) < 1e-10);
    REQUIRE((repeated.stylus[0].proxy - found.stylus[0].proxy).norm() <
            (command.given ? 1e-10 : 1.0));
  }
}

TEST_CASE("step: the same commands give the same bits", "[unsanitized]") {
  for (const ResponseKind kind : {ResponseKind::kModal, ResponseKind::kDense}) {
    const auto model = fem_cube({3, 2000.0, 8.0, 0.002, 100}, kind);
    Simulation a(one(model));
    Simulation b(one(model));
    const auto first = play(a, swing, 600);
    const auto second = play(b, swing, 600);
    for (std::size_t k = 0; k < first.size(); ++k) {
      REQUIRE(first[k].object[0].position == second[k].object[0].position);
      REQUIRE(first[k].object[0].orientation.coeffs() == second[k].object[0].orientation.coeffs());
      REQUIRE(first[k].stylus[0].force == second[k].stylus[0].force);
    }
    CHECK(largest_force(first) > 0.5);
  }
}

TEST_CASE("step: reset puts everything back") {
  Simulation simulation(one(fem_cube({})));
  const auto first = play(simulation, swing, 400);
  simulation.reset();
  const auto second = play(simulation, swing, 400);
  for (std::size_t k = 0; k < first.size(); ++k) {
    REQUIRE(first[k].stylus[0].force == second[k].stylus[0].force);
  }
}

TEST_CASE("step: dense and modal engines give the same forces and motion over 3 T steps",
          "[slow]") {
  // Damped so that less than 1e-5 of R is left at T: the engines then differ by rounding alone.
  // What the cut at T does is accounted for exactly in the test of the engines.
  FemCube cube;
  cube.cells = 3;
  cube.rayleigh_alpha = 50.0;
  cube.steps = 300;
  Simulation modal(one(fem_cube(cube)));
  Simulation dense(one(fem_cube(cube, ResponseKind::kDense)));
  // Comes, pokes here and there on the top face wherever the cube has gone, holds, lets go, comes
  // again.
  const auto path = [](double t, const RigidState& body) {
    const double phase = std::fmod(t, 0.3);
    const int visit = static_cast<int>(t / 0.3);
    const double depth = 0.006 * std::sin(std::numbers::pi * phase / 0.3);
    const Vector3 on_body(0.03 * std::sin(2.1 * visit) + 0.01 * phase, kHalfEdge + 0.002 - depth,
                          0.03 * std::cos(1.3 * visit));
    const Vector3 drift = phase * body.velocity;
    return at_tip(body.position + drift + body.orientation * on_body,
                  visit % 2 == 1 && phase < 0.2);
  };
  // Every visit starts from where the engine's own cube is: the pose integrates the forces'
  // rounding twice, and a tip given in W would turn micrometres of it into millinewtons at the next
  // contact.
  RigidState modal_start, dense_start;
  double peak = 0.0;
  double worst_force = 0.0;
  double worst_position = 0.0;
  double worst_displacement = 0.0;
  double largest_displacement = 0.0;
  int changes = 0;
  ContactState last = ContactState::kFree;
  StepRecord expected, found;
  Points u, v;
  for (int k = 0; k < 3 * cube.steps; ++k) {
    if (k % 150 == 0) {
      modal_start = body_of(modal);
      dense_start = body_of(dense);
    }
    const double time = (k + 1) * modal.dt();
    const StylusCommand modal_command = path(time, modal_start);
    const StylusCommand dense_command = path(time, dense_start);
    modal.step({&modal_command, 1}, expected);
    dense.step({&dense_command, 1}, found);
    REQUIRE(found.stylus[0].contact == expected.stylus[0].contact);
    const Vector3 difference = found.stylus[0].force - expected.stylus[0].force;
    modal.object().engine().displacement(u);
    dense.object().engine().displacement(v);
    peak = std::max(peak, expected.stylus[0].force.norm());
    worst_force = std::max(worst_force, difference.norm());
    worst_position =
        std::max(worst_position, (found.object[0].position - expected.object[0].position).norm());
    worst_displacement = std::max(worst_displacement, (u - v).cwiseAbs().maxCoeff());
    largest_displacement = std::max(largest_displacement, u.cwiseAbs().maxCoeff());
    if (expected.stylus[0].contact != last) ++changes;
    last = expected.stylus[0].contact;
  }
  INFO("peak " << peak << " N, force " << worst_force << " N, displacement " << worst_displacement
               << " of " << largest_displacement << " m, position " << worst_position << " m");
  CHECK(peak > 0.05);
  CHECK(changes >= 12);
  CHECK(worst_force < 1e-4 * peak);
  CHECK(worst_displacement < 1e-4 * largest_displacement);
  CHECK(worst_position < 1e-5);
}

TEST_CASE("deformation follows the force thread's engine exactly, and survives lost steps") {
  const auto model = fem_cube({});
  Simulation simulation(one(model));
  Deformation whole(one(model));
  Deformation holed(one(model));
  const auto records = play(simulation, swing, 800);
  for (const StepRecord& record : records) {
    whole.follow(record);
    if (record.force_step % 10 != 3) holed.follow(record);
  }
  Points u;
  simulation.object().engine().displacement(u);
  SurfaceFrame frame = rest_frame(one(model));
  whole.compute(frame);
  CHECK(frame.objects[0].displacement == u);
  CHECK(frame.objects[0].position == records.back().object[0].position);
  const StylusRecord& stylus = records.back().stylus[0];
  const Vector3 touched = interpolate(records.back().object[0].contact[0].point, [&](int i) {
    return frame.objects[0].world(model->mesh, i);
  });
  CHECK((touched - stylus.proxy).norm() < 1e-9);
  holed.compute(frame);
  CHECK(holed.lost_steps() == 80);
  CHECK((frame.objects[0].displacement - u).norm() < 0.05 * u.norm());
}
