// Run files of two objects and two styluses, with edits of the fuzzer's choice.
#include <vector>

#include "common/error.hpp"
#include "replay/compare/run_reader.hpp"
#include "replay/output/run_output.hpp"
#include "replay/traced_scene.hpp"
#include "tests/fuzz/edited_file.hpp"
#include "tests/fuzz/harness.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/server/two_cubes.hpp"

namespace irdm::fuzz {
namespace {

std::filesystem::path valid_run() {
  constexpr int kFrames = 4;
  replay::TracedScene scene;
  scene.objects = {{"one", "a.h5", "1"}, {"two", "b.h5", "2"}};
  scene.config = test::two_cubes();
  const std::filesystem::path path = scratch_file("valid_run.h5", "");
  std::filesystem::remove(path);
  replay::RunOutput output(path, scene, {"trace.h5", "inputs"});
  StepRecord record;
  record.object_count = record.stylus_count = 2;
  const int nodes = scene.config.objects[0].model->mesh.surface_node_count();
  const std::vector<Points> displacement(2, Points::Constant(nodes, 3, 1e-3));
  for (int k = 0; k < kFrames; ++k) {
    record.time = 0.1 * k;
    output.put({record, displacement});
  }
  output.finish();
  return path;
}

}  // namespace

void run_file(Input input) {
  static const EditedFile file(valid_run());
  const std::filesystem::path path = file.edited(input);
  try {
    const replay::RunReader run(path);
    Points u;
    for (std::size_t frame = 0; frame < run.times().size(); ++frame) {
      for (std::size_t i = 0; i < run.objects().size(); ++i) {
        run.pose(i, frame);
        run.displacement(i, frame, u);
        expect(u.rows() == run.rest(i).rows(), "every node has its displacement");
      }
      for (std::size_t s = 0; s < run.styluses(); ++s) run.force(s, frame);
    }
    for (std::size_t i = 0; i < run.objects().size(); ++i) {
      const Points node = run.node_displacement(i, run.rest(i).rows() - 1);
      expect(static_cast<std::size_t>(node.rows()) == run.times().size(), "a row for every frame");
    }
  } catch (const Error&) {
    expect(!input.empty(), "a run can be read as it was written");
  }
}

}  // namespace irdm::fuzz
