// What is written of a run in which a bridge told of forces after their steps.

#include "common/checksum.hpp"
#include "common/model/model_writer.hpp"
#include "replay/compare/run_reader.hpp"
#include "replay/replay.hpp"
#include "replay/traced_scene.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/synthetic_model.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/trace_writer.hpp"

using namespace irdm;
using namespace irdm::replay;
using namespace irdm::test;

namespace {

constexpr int kSteps = 40;

void write_model(const std::filesystem::path& path) {
  const Model model = synthetic_cube(2, 6, 10);
  ModelFileWriter writer(path);
  writer.write_description(model);
  writer.write_modal(std::get<ModalResponse>(model.response));
  writer.commit();
}

/// Nobody touches the cube when its steps are made; all that acts comes late.
std::vector<StepRecord> late_run(const SimulationConfig& config) {
  Simulation simulation(config);
  std::vector<StepRecord> records(kSteps);
  for (int k = 0; k < kSteps; ++k) {
    for (int age = 0; k > 10 && k < 30 && age < k % 4; ++age) {
      REQUIRE(simulation.insert_delayed_force(
          LateForce{0, 0, age, {}, Vector3(0.01, -0.03, 0.01 * age), Vector3(0.02, 0.06, 0.0)}));
    }
    const StylusCommand command{true, 0, Vector3(0, 0.1, 0), {}};
    simulation.step({&command, 1}, records[static_cast<std::size_t>(k)]);
  }
  return records;
}

}  // namespace

TEST_CASE("a replay's output has the force that acted in the end, as the trace says it") {
  const TemporaryFolder folder;
  const std::filesystem::path model = folder.path() / "cube.h5";
  const std::filesystem::path trace = folder.path() / "trace.h5";
  const std::filesystem::path output = folder.path() / "run.h5";
  write_model(model);
  const TraceHeader header{{{"cube", "cube.h5", sha256_of_file(model)}},
                           "[[object]]\nname = \"cube\"\nmodel = \"cube.h5\"\n",
                           0.002,
                           1,
                           false};
  TraceWriter(trace, header).close();
  const SimulationConfig config = read_traced_scene(trace, {}, std::nullopt).config;
  std::filesystem::remove(trace);
  const std::vector<StepRecord> records = late_run(config);
  TraceWriter writer(trace, header);
  writer.append(records);
  writer.close();

  ReplayOptions options;
  options.trace = trace;
  options.from_inputs = GENERATE(false, true);
  options.output = output;
  REQUIRE(replay::replay(options) == 0);
  const RunReader run(output);
  const hdf5::File file = hdf5::File::open(trace);
  const auto applied = file.read<double>("/stylus/0/applied_force", {kSteps, 3});
  double largest = 0.0;
  for (std::size_t k = 0; k < kSteps; ++k) {
    CHECK(records[k].stylus[0].force.isZero(0.0));
    const Vector3 expected(applied.data() + 3 * k);
    CHECK((run.force(0, k) - expected).norm() < 1e-15);
    largest = std::max(largest, expected.norm());
  }
  CHECK(largest > 0.05);
}
