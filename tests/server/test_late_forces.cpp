// What a trace says of forces that bridges told of after their steps.
#include <vector>

#include "tests/server/two_cubes.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"
#include "trace/recording.hpp"
#include "trace/trace_writer.hpp"

using namespace irdm;
using namespace irdm::test;

namespace {

const std::vector<std::string> kNames{"one", "other"};

/// Two cubes that are touched; forces of both styluses come late, on both objects, off the centre.
std::vector<StepRecord> late_run(const SimulationConfig& config) {
  Simulation simulation(config);
  std::vector<StepRecord> records(80);
  for (int k = 0; k < 80; ++k) {
    for (int age = 0; k > 30 && k < 60 && age < k % 4; ++age) {
      for (const int object : {1, 0}) {
        LateForce late{object, 1 - object, age, {}, Vector3(0.002, -0.01, 0.001 * age), {}};
        const auto corners = config.objects[0].model->mesh.triangles.row(0);
        late.point = {{corners[0], corners[1], corners[2]}, {0.2, 0.3, 0.5}};
        late.arm = Vector3(0.02, 0.06, 0.01 * object);
        REQUIRE(simulation.insert_delayed_force(late));
      }
    }
    const double depth = std::min(2e-4 * k, 0.01);
    const std::array<StylusCommand, 2> commands{
        StylusCommand{k > 5, 0, Vector3(0.01, 0.064 - depth, 0.005), {}},
        StylusCommand{true, k > 20 ? kGrabButton : 0, Vector3(0.30 + 1e-4 * k, 0.17, 0.0), {}}};
    simulation.step(commands, records[static_cast<std::size_t>(k)]);
  }
  return records;
}

void write(const std::filesystem::path& path, const std::vector<StepRecord>& records,
           std::size_t batch) {
  TraceWriter writer(
      path,
      {{{kNames[0], "cube.h5", "sum"}, {kNames[1], "cube.h5", "sum"}}, "scene", 0.002, 2, true});
  const std::span<const StepRecord> all(records);
  for (std::size_t k = 0; k < all.size(); k += batch) {
    writer.append(all.subspan(k, std::min(batch, all.size() - k)));
  }
  writer.close();
}

}  // namespace

TEST_CASE("a recording gives the state that each object began a step with, late forces included") {
  const TemporaryFolder folder;
  const SimulationConfig config = two_cubes();
  const std::vector<StepRecord> records = late_run(config);
  write(folder.path() / "trace.h5", records, 80);
  const Recording recording(folder.path() / "trace.h5", config, kNames);
  REQUIRE(recording.steps() == records.size());
  StepRecord read;
  for (std::size_t k = 0; k < records.size(); ++k) {
    recording.step(k, read);
    REQUIRE(read.late.count == records[k].late.count);
    for (std::size_t i = 0; i < 2; ++i) {
      INFO("step " << k << ", object " << i);
      const RigidState& start = read.object[i].start;
      const RigidState& expected = records[k].object[i].start;
      CHECK((start.position - expected.position).norm() < 1e-15);
      CHECK((start.orientation.coeffs() - expected.orientation.coeffs()).norm() < 1e-15);
      CHECK((start.velocity - expected.velocity).norm() < 1e-15);
      CHECK((start.angular_momentum - expected.angular_momentum).norm() < 1e-16);
    }
  }
}

TEST_CASE("a trace says what acted in the end beside what was known in the step") {
  const TemporaryFolder folder;
  const std::size_t batch = GENERATE(1, 7, 80);
  const bool lost = GENERATE(false, true);
  std::vector<StepRecord> records = late_run(two_cubes());
  std::vector<std::array<Vector3, 2>> expected;
  for (const StepRecord& r : records) expected.push_back({r.stylus[0].force, r.stylus[1].force});
  int late_forces = 0;
  for (std::size_t k = 0; k < records.size(); ++k) {
    for (const LateForce& late : records[k].late.view()) {
      const std::size_t own = k - 1 - static_cast<std::size_t>(late.age);
      expected[own][static_cast<std::size_t>(late.stylus)] -=
          records[own].object[static_cast<std::size_t>(late.object)].halfway * late.force;
      ++late_forces;
    }
  }
  REQUIRE(late_forces > 50);
  if (lost) {  // on the way to the disk, with what came late in that step
    constexpr std::ptrdiff_t kLost = 40;  // in which nothing came late
    REQUIRE(records[kLost].late.count == 0);
    records.erase(records.begin() + kLost);
    expected.erase(expected.begin() + kLost);
  }
  write(folder.path() / "trace.h5", records, batch);
  const hdf5::File file = hdf5::File::open(folder.path() / "trace.h5");
  CHECK(file.shape("/stylus/0/applied_force") == hdf5::Shape{records.size(), 3});
  for (std::size_t s = 0; s < 2; ++s) {
    const std::string path = "/stylus/" + std::to_string(s);
    const auto known = file.read<double>(path + "/force", {records.size(), 3});
    const auto applied = file.read<double>(path + "/applied_force", {records.size(), 3});
    for (std::size_t k = 0; k < records.size(); ++k) {
      INFO("row " << k << ", stylus " << s);
      CHECK(Vector3(known.data() + 3 * k) == records[k].stylus[s].force);
      CHECK((Vector3(applied.data() + 3 * k) - expected[k][s]).norm() < 1e-15);
    }
  }
}
