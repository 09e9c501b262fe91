// Traces of three objects, two of which touch, and two styluses, with edits of the fuzzer's choice.
#include "common/error.hpp"
#include "replay/rerun/deviation.hpp"
#include "replay/rerun/rerun.hpp"
#include "tests/fuzz/edited_file.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/server/two_cubes.hpp"
#include "trace/recording.hpp"
#include "trace/trace_layout.hpp"

namespace irdm::fuzz {
namespace {

constexpr int kSteps = 120;
const std::vector<std::string> kNames = {"one", "two", "three"};

const SimulationConfig& scene() {
  static const SimulationConfig config = [] {
    SimulationConfig cubes = test::two_cubes();
    cubes.objects.push_back(cubes.objects[1]);
    cubes.objects[2].position.x() += 0.1215;  // as it turns it touches the second
    return cubes;
  }();
  return config;
}

std::filesystem::path valid_trace() {
  const std::filesystem::path path = scratch_file("valid_trace.h5", "");
  std::filesystem::remove(path);
  Simulation simulation(scene());
  std::vector<StepRecord> records(kSteps);
  for (int k = 0; k < kSteps; ++k) {
    StepRecord& record = records[static_cast<std::size_t>(k)];
    test::play_step(simulation, k, record);
    if (k % 9 == 0) record.stylus[0].bridged = BridgedForce{.object = k % 2};
  }
  expect(std::ranges::any_of(records, [](const StepRecord& r) { return !r.body_contact.empty(); }),
         "objects touch");
  TraceWriter writer(
      path, {{{kNames[0], "a.h5", "1"}, {kNames[1], "b.h5", "2"}, {kNames[2], "c.h5", "3"}},
             "scene",
             0.002,
             2,
             true,
             true});
  writer.append(records);
  writer.close();
  return path;
}

/// What comes out need not be what was recorded; it is finite, or irdm-replay refuses the trace.
void rerun_all(replay::Rerun& made, const Recording& recording) {
  constexpr std::size_t kMost = 60;
  StepRecord recorded;
  StepRecord again;
  std::vector<Points> displacements(scene().objects.size());
  for (std::size_t k = 0; k < std::min(recording.steps(), kMost); ++k) {
    recording.step(k, recorded);
    expect(replay::is_finite(recorded), "steps that are read are finite");
    made.step(recorded, again);
    replay::require_finite(again, "it.h5");
    for (std::size_t i = 0; i < displacements.size(); ++i) made.displacement(i, displacements[i]);
    replay::require_finite(displacements, "it.h5");
  }
}

}  // namespace

void trace_file(Input input) {
  static const EditedFile file(valid_trace());
  const std::filesystem::path path = file.edited(input);
  try {
    read_trace_header(path);
    expect(read_trace_objects(path, kNames).size() == kNames.size(), "every object has its model");
    const Recording recording(path, scene(), kNames);
    recording.lost_steps();
    StepRecord record;
    for (std::size_t k = 0; k < recording.steps(); ++k) {
      recording.step(k, record);
      expect(record.body_contact.size() <= kMaxBodyContacts, "contacts of bodies fit into a step");
      for (std::size_t i = 0; i < scene().objects.size(); ++i) {
        expect(record.object[i].floor_count <= kMaxFloorContacts,
               "the floor's forces fit into a step");
      }
    }
    replay::ForceRerun from_forces(scene());
    rerun_all(from_forces, recording);
    replay::InputRerun from_inputs(scene());
    rerun_all(from_inputs, recording);
  } catch (const Error&) {
    expect(!input.empty(), "a trace can be read as it was written");
  }
}

}  // namespace irdm::fuzz
