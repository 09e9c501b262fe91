// Runs that are rerun from their traces, against what they were.

#include "replay/rerun/rerun.hpp"
#include "simulation/step/bridged_stylus.hpp"
#include "tests/replay/rerun_checks.hpp"
#include "tests/server/two_cubes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fem_cube.hpp"

using namespace irdm;
using namespace irdm::replay;
using namespace irdm::test;

namespace {

constexpr std::uint64_t kSession = 3;

void check_both(const KeptRun& run) {
  check_to_the_bit(run);
  check_from_forces(run);
  double peak = 0.0;
  for (const StepRecord& record : run.records) {
    for (const StylusRecord& stylus : record.stylus) peak = std::max(peak, stylus.force.norm());
  }
  CHECK(peak > 0.1);
}

/// Falls, spins, is touched and held, changes its settings, is reset; forces come late.
KeptRun fall(std::size_t objects) {
  SimulationConfig config = two_cubes();
  config.objects.resize(objects);
  KeptRun run(config);
  Simulation simulation(config);
  StepRecord record;
  for (int k = 0; k < 160; ++k) {
    play_step(simulation, k, record);
    run.keep(simulation, record);
  }
  return run;
}

/// A fixed cube that sags, is touched and held, swings as gravity changes, and is reset.
KeptRun sag() {
  Model model = synthetic_cube(3, 12, 40);
  add_gravity(model, true);
  model.body.support = Support::kFixed;
  SimulationConfig config;
  config.gravity = Vector3(0.5, -9.81, 1);
  config.styluses = {{0.0, 300.0, 0.02}};
  config.objects.resize(1);
  config.objects[0].model = std::make_shared<const Model>(model);
  config.objects[0].orientation = Quaternion(Eigen::AngleAxisd(0.3, Vector3::UnitY()));
  KeptRun run(config);
  Simulation simulation(config);
  StepRecord record;
  for (int k = 0; k < 160; ++k) {
    if (k == 60 || k == 110) {
      Settings settings = simulation.settings();
      settings.gravity = Vector3(0, -0.1 * k, -2);
      simulation.set(settings);
    }
    const double depth = std::min(2e-4 * k, 0.01);
    const StylusCommand command{
        k > 5, k > 40 && k < 130 ? kGrabButton : 0, Vector3(0.01, 0.064 - depth, 0.005), {}};
    simulation.step({&command, 1}, record, k == 110);
    run.keep(simulation, record);
  }
  return run;
}

Vector3 told_force(int k) {
  return {0.05 * std::sin(0.3 * k), k % 40 < 30 ? -0.3 : 0.0, 0.03 * std::cos(0.2 * k)};
}

/// What the bridge tells, and when.
struct Telling {
  double strength = 1.0;   ///< factor on the forces
  std::size_t latest = 4;  ///< that a force comes [steps]
  std::uint32_t buttons = 0;
};

/// The first stylus has a bridge that solves its contact; what it tells arrives some steps
/// late, and for a while there is another bridge.
KeptRun bridged_run(const SimulationConfig& config, const Telling& telling = {}) {
  KeptRun run(config);
  Simulation simulation(run.config);
  BridgedStylus bridged(simulation, 0);
  AppliedHistory history(kSession);
  std::vector<std::vector<AppliedForces>> arrivals(200);
  StepRecord record;
  ContactModel model;
  std::uint64_t session = kSession;
  for (int k = 0; k < 160; ++k) {
    const auto step = static_cast<std::size_t>(k);
    const Vector3 tip(0.01 + 1e-4 * k, 0.064 - std::min(2e-4 * k, 0.009), 0.005);
    AppliedForces told{.step = step, .base = step, .count = 1, .past = {}};
    told.past[0] = {telling.strength * told_force(k), tip, Vector3(0.012, 0.055, 0.004)};
    arrivals[step + (7 * step) % (telling.latest + 1)].push_back(told);
    if (k == 130) history = AppliedHistory(++session);
    for (const AppliedForces& applied : arrivals[step]) history.take(applied);
    const StylusCommand other{
        true, k > 20 && k < 90 ? kGrabButton : 0, Vector3(0.30 + 1e-4 * k, 0.17, 0.0), {}};
    const std::array commands{bridged.next({k > 3, telling.buttons, tip, {}}, session, history),
                              other};
    simulation.step(commands, record, k == 100);
    bridged.predict_horizon(model);
    run.keep(simulation, record);
  }
  run.limited = simulation.limited();
  return run;
}

KeptRun bridged_fall() {
  return bridged_run(two_cubes());
}

/// The same in the air, where no late force presses a cube on the floor.
KeptRun bridged_flight() {
  SimulationConfig config = two_cubes();
  config.floor.reset();
  config.gravity.setZero();
  for (SimulationObject& object : config.objects) object.tether = {1000.0, 10.0};
  return bridged_run(config);
}

/// A tethered cube: a fingertip slides over its top and round an edge, and a point takes hold of it
/// from a distance.
KeptRun slide_over_an_edge() {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = fem_cube({.cells = 4, .poisson_ratio = 0.45});
  config.objects[0].friction = {0.2, 0.15};
  config.objects[0].tether = {50.0, 0.1};
  config.objects[0].damping = {2.0, 2.0};
  config.styluses = {{0.01, 1000.0, 0.0}, {0.0, 1000.0, 0.02}};
  KeptRun run(config);
  Simulation simulation(config);
  StepRecord record;
  for (int k = 0; k < 500; ++k) {
    const double depth = std::min(1e-4 * k, 0.012);
    const std::array<StylusCommand, 2> commands{
        StylusCommand{true, 0, Vector3(2e-4 * std::max(k - 100, 0), 0.065 - depth, 0.045), {}},
        StylusCommand{
            true, k > 200 && k < 400 ? kGrabButton : 0, Vector3(-0.07, 5e-5 * k, -2e-5 * k), {}}};
    simulation.step(commands, record);
    run.keep(simulation, record);
  }
  return run;
}

}  // namespace

TEST_CASE("forces act where they acted: off the surface's point, near an edge and held from afar",
          "[unsanitized]") {
  const KeptRun run = slide_over_an_edge();
  std::array<double, 2> offset{};
  int slipping = 0;
  for (const StepRecord& record : run.records) {
    for (std::size_t s = 0; s < 2; ++s) {
      const ContactRecord& contact = record.object[0].contact[s];
      if (contact.state == ContactState::kFree) continue;
      offset[s] = std::max(offset[s], contact.offset.norm());
      slipping += contact.slipping ? 1 : 0;
    }
  }
  REQUIRE(offset[0] > 1e-3);
  REQUIRE(offset[1] > 5e-3);
  REQUIRE(slipping > 50);
  check_both(run);
}

TEST_CASE("a run with a ball that presses, holds and lets go is rerun") {
  SimulationConfig config;
  config.objects.resize(GENERATE(1, 2));
  for (SimulationObject& object : config.objects) {
    object.model = fem_cube({.cells = 2, .order = 2});
    object.tether = {50.0, 0.1};
    object.friction = {0.5, 0.4};
  }
  config.objects.back().position.x() += config.objects.size() > 1 ? 0.14 : 0.0;
  config.styluses = {{.radius = 0.012, .coupling_stiffness = 300.0, .ball = true}, {}};
  KeptRun run(config);
  Simulation simulation(config);
  StepRecord record;
  int held = 0;
  int both = 0;
  for (int k = 0; k < 200; ++k) {
    const double depth = std::min(2e-4 * k, 0.012);
    const std::array<StylusCommand, 2> commands{
        StylusCommand{true,
                      k > 90 && k < 140 ? kGrabButton : 0,
                      Vector3(0.01 + 5e-5 * k, 0.076 - depth, 0.005),
                      {}},
        StylusCommand{}};
    simulation.step(commands, record);
    run.keep(simulation, record);
    const bool holds = record.object[0].contact[0].state == ContactState::kHeld;
    held += holds ? 1 : 0;
    both += holds && !record.body_contact.empty() ? 1 : 0;
  }
  REQUIRE(held > 40);
  REQUIRE(both > 5);  // while it lets go
  REQUIRE(record.stylus[0].force.norm() > 0.01);
  check_both(run);
}

TEST_CASE("a run of a fixed object that sags is rerun, to the bit from its tips") {
  check_both(sag());
}

TEST_CASE("a run is rerun: floor, spin, settings, a reset and late forces") {
  const KeptRun run = fall(GENERATE(1, 2));
  std::size_t late = 0;
  for (const StepRecord& record : run.records) late += record.late.count;
  REQUIRE(late > 10);
  check_both(run);
}

TEST_CASE("a run in which a bridge solved contacts is rerun") {
  const KeptRun run = bridged_fall();
  std::size_t late = 0;
  std::size_t bridged = 0;
  double peak = 0.0;
  for (const StepRecord& record : run.records) {
    late += record.late.count;
    if (!record.stylus[0].bridged) continue;
    ++bridged;
    peak = std::max(peak, record.stylus[0].force.norm());
  }
  REQUIRE(late > 20);
  REQUIRE(bridged > 100);
  REQUIRE(peak > 0.1);
  check_both(run);
}

TEST_CASE("a run in which a bridge's forces acted in part only is rerun") {
  SimulationConfig config = two_cubes();
  config.floor.reset();
  const KeptRun run = bridged_run(config, {60.0, 1, kGrabButton});
  REQUIRE(run.limited > 5);
  int in_part = 0;
  for (const StepRecord& record : run.records) {
    if (!record.stylus[0].bridged) continue;
    const double share = record.stylus[0].bridged->share.value_or(1.0);
    in_part += share > 0.0 && share < 1.0 ? 1 : 0;
  }
  REQUIRE(in_part > 0);
  check_both(run);
}

TEST_CASE("what a bridge told acted in the end, whenever it came") {
  const KeptRun run = bridged_flight();
  const std::vector<DelayedForces> told = delayed_forces(run.recording());
  int came_late = 0;
  double largest = 0.0;
  for (std::size_t k = 10; k < 95; ++k) {
    StepRecord record = run.records[k];
    const Vector3 expected = -told_force(static_cast<int>(k));
    came_late += (record.stylus[0].force - expected).norm() > 0.01 ? 1 : 0;
    add_delayed_forces(told, k, false, record);
    largest = std::max(largest, (record.stylus[0].force - expected).norm());
  }
  CHECK(came_late > 20);
  INFO("largest difference " << largest << " N");
  CHECK(largest < 1e-3);  // the object was believed to stand otherwise when it came
}

TEST_CASE("late forces act on a cube on the floor but for what pressed it down") {
  const KeptRun run = bridged_fall();
  const std::vector<DelayedForces> told = delayed_forces(run.recording());
  double largest = 0.0;
  double most_missing = 0.0;
  for (std::size_t k = 10; k < 95; ++k) {
    StepRecord record = run.records[k];
    add_delayed_forces(told, k, false, record);
    const Vector3 missing = record.stylus[0].force + told_force(static_cast<int>(k));
    most_missing = std::max(most_missing, -missing.y());
    largest = std::max({largest, std::hypot(missing.x(), missing.z()), missing.y()});
  }
  INFO("largest difference " << largest << " N, missing pressure " << most_missing << " N");
  CHECK(std::abs(largest) < 1e-3);
  CHECK(most_missing > 0.2);
}

TEST_CASE("forces of held points that were found anew have what was told late") {
  StepRecord record;
  record.object[0].contact[0].state = ContactState::kHeld;
  record.stylus[0] = {.present = true, .buttons = kGrabButton, .force = Vector3(1, 0, 0)};
  std::vector<DelayedForces> told(1);
  told[0].step = 4;
  told[0].late.force = Vector3(0, 2, 0);
  add_delayed_forces(told, 4, true, record);
  CHECK(record.stylus[0].force == Vector3(1, 0, 0));
  record.stylus[0].buttons = 0;  // it is given up: what was recorded acts
  add_delayed_forces(told, 4, true, record);
  CHECK(record.stylus[0].force == Vector3(1, -2, 0));
  add_delayed_forces(told, 5, false, record);
  CHECK(record.stylus[0].force == Vector3(1, -2, 0));
}

TEST_CASE("what a viewer recorded is rerun: it begins with a reset, and settings as they were") {
  SimulationConfig config = two_cubes();
  config.floor.reset();
  config.objects[0].friction = {0.3, 0.2};
  KeptRun run(config);
  Simulation simulation(config);
  Settings settings = simulation.settings();
  settings.gravity = Vector3(0.1, -0.3, 0.0);
  settings.object[0].material_damping = 3.0;
  settings.object[0].friction = {1.0, 0.9};
  settings.object[1].tether = {5.0, 0.01};
  settings.object[1].damping = {1.0, 2.0};
  StepRecord record;
  for (int k = 0; k < 160; ++k) {
    if (k == 20) simulation.set(settings);
    const double depth = std::min(1e-4 * (k % 80), 0.006);
    const std::array<StylusCommand, 2> commands{
        StylusCommand{true, 0, Vector3(0.01, 0.061 - depth, 0.005), {}},
        StylusCommand{true,
                      k % 70 > 20 || (k > 65 && k < 76) ? kGrabButton : 0,
                      Vector3(0.30 + 1e-4 * (k % 70), 0.17, 0.0),
                      {}}};
    simulation.step(commands, record, k == 70);
    if (k >= 70) run.keep(simulation, record);
  }
  REQUIRE(run.records[0].reset);
  check_both(run);
}

TEST_CASE("steps that were lost on the way to the disk are counted") {
  KeptRun run = fall(1);
  run.records.erase(run.records.begin() + 40, run.records.begin() + 43);
  CHECK(run.recording().lost_steps() == 3);
}

TEST_CASE("contacts that a bridge solved can be solved in the step instead") {
  const KeptRun run = bridged_fall();
  InputRerun made(run.config, true);
  const Recording recording = run.recording();
  Simulation alone(run.config);
  StepRecord recorded;
  StepRecord again;
  StepRecord expected;
  double difference = 0.0;
  for (std::size_t k = 0; k < recording.steps(); ++k) {
    recording.step(k, recorded);
    made.step(recorded, again);
    std::array<StylusCommand, 2> commands;
    for (std::size_t s = 0; s < 2; ++s) {
      const StylusRecord& stylus = run.records[k].stylus[s];
      commands[s] = {stylus.present, stylus.buttons, stylus.tip, {}};
    }
    alone.step(commands, expected, run.records[k].reset);
    REQUIRE(again.late.count == 0);
    REQUIRE(again.stylus[0].force == expected.stylus[0].force);
    REQUIRE(again.object[0].position == expected.object[0].position);
    difference = std::max(difference, (again.stylus[0].force - recorded.stylus[0].force).norm());
  }
  CHECK(difference > 0.01);
}
