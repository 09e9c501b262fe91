// Recorded runs with a tool.

#include "replay/rerun/rerun.hpp"
#include "tests/simulation/led_rod.hpp"
#include "tests/simulation/pressed_cube.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/trace_layout.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

constexpr int kToolSteps = 600;

// A rod that comes down on a soft cube and turns, and whose stylus goes away for a while.
SimulationConfig led_scene() {
  SimulationConfig config = led_rod();
  config.objects.resize(2);
  config.objects[1].model = fem_cube({.cells = 3, .youngs_modulus = 5e3});
  config.objects[1].tether = {500.0, 5.0};
  for (SimulationObject& object : config.objects) object.friction = {0.6, 0.5};
  config.objects[0].position = Vector3(0.01, kHalfEdge + 0.5 * kRodLength + 0.003, 0.0);
  return config;
}

StylusCommand command_at(int k) {
  StylusCommand command = lead_to(Vector3(0.01, kHalfEdge + 0.003 - 2e-5 * k, 0.0),
                                  rotation_from_vector(Vector3(1e-4 * k, 0.0, 2e-4 * k)));
  command.present = k < 400 || k >= 450;
  return command;
}

/// Made, written and read back.
struct LedRun {
  LedRun() {
    Simulation simulation(config);
    records.resize(kToolSteps);
    for (int k = 0; k < kToolSteps; ++k) {
      const StylusCommand command = command_at(k);
      simulation.step({&command, 1}, records[static_cast<std::size_t>(k)], k == 300);
    }
    TraceHeader header{{}, "scene", 0.002, 1, false, true, tool_styluses(config)};
    for (const char* name : {"rod", "cube"}) header.objects.push_back({name, "m.h5", "sum"});
    TraceWriter writer(path, header);
    writer.append(records);
    writer.close();
  }

  TemporaryFolder folder;
  std::filesystem::path path = folder.path() / "trace.h5";
  SimulationConfig config = led_scene();
  std::vector<StepRecord> records;
};

}  // namespace

TEST_CASE("trace: orientation and torque of a stylus with a tool are read as they were written") {
  const LedRun run;
  CHECK(read_trace_header(run.path).tools == std::vector<int>{0});
  const Recording recording(run.path, run.config, {"rod", "cube"});
  const auto record = std::make_unique<StepRecord>();
  int touching = 0;
  for (std::size_t k = 0; k < run.records.size(); ++k) {
    recording.step(k, *record);
    const StylusRecord& stylus = record->stylus[0];
    REQUIRE(stylus.tool == 0);
    REQUIRE(stylus.orientation.coeffs() == run.records[k].stylus[0].orientation.coeffs());
    REQUIRE(stylus.torque == run.records[k].stylus[0].torque);
    touching += !record->body_contact.empty() && !stylus.torque.isZero(0.0) ? 1 : 0;
  }
  CHECK(touching > 100);
  const hdf5::File file = hdf5::File::open(run.path);
  CHECK(file.stored_shape("/stylus/0/orientation") == hdf5::Shape{kToolSteps, 4});
  CHECK(file.stored_shape("/stylus/0/torque") == hdf5::Shape{kToolSteps, 3});
}

TEST_CASE("a run with a tool is rerun to the bit, from its commands and from its forces") {
  const LedRun run;
  const Recording recording(run.path, run.config, {"rod", "cube"});
  replay::InputRerun inputs(run.config, false);
  replay::ForceRerun forces(run.config);
  const auto recorded = std::make_unique<StepRecord>();
  const auto again = std::make_unique<StepRecord>();
  double off = 0.0;
  for (std::size_t k = 0; k < run.records.size(); ++k) {
    recording.step(k, *recorded);
    const StepRecord& was = run.records[k];
    inputs.step(*recorded, *again);
    REQUIRE(again->stylus[0].force == was.stylus[0].force);
    REQUIRE(again->stylus[0].torque == was.stylus[0].torque);
    REQUIRE(again->stylus[0].proxy == was.stylus[0].proxy);
    REQUIRE(again->object[0].position == was.object[0].position);
    REQUIRE(again->object[0].orientation.coeffs() == was.object[0].orientation.coeffs());
    REQUIRE(again->object[1].position == was.object[1].position);
    forces.step(*recorded, *again);
    off = std::max(off, (again->object[0].position - was.object[0].position).norm());
    REQUIRE(again->stylus[0].force == was.stylus[0].force);
  }
  INFO("the rod under its recorded forces is off by at most " << off << " m");
  CHECK(off < 1e-12);
}
