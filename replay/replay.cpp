#include "replay/replay.hpp"

#include <iostream>
#include <memory>

#include "common/error.hpp"
#include "replay/frame_steps.hpp"
#include "replay/made_again/deviation.hpp"
#include "replay/made_again/from_forces.hpp"
#include "replay/made_again/from_tips.hpp"
#include "replay/output/csv_output.hpp"
#include "replay/output/run_output.hpp"
#include "replay/output/vtk_output.hpp"
#include "replay/traced_scene.hpp"
#include "server/record/recording.hpp"

namespace irdm::replay {
namespace {

using Outputs = std::vector<std::unique_ptr<FrameOutput>>;

Recording read_recording(const TracedScene& scene, const std::string& trace) {
  Recording recording(trace, scene.config, scene.names());
  if (recording.lost_steps() == 0) return recording;
  throw Error(trace,
              "lacks " + std::to_string(recording.lost_steps()) +
                  " steps, which were lost on the way to the disk",
              "record it again on a disk that is fast enough");
}

std::unique_ptr<MadeAgain> make_again(const TracedScene& scene, const ReplayOptions& options) {
  if (options.from_tips) return std::make_unique<FromTips>(scene.config, options.solve_bridged);
  return std::make_unique<FromForces>(scene.config);
}

Outputs make_outputs(const ReplayOptions& options, const TracedScene& scene) {
  Outputs outputs;
  if (options.csv) outputs.push_back(std::make_unique<CsvOutput>(*options.csv, scene));
  if (options.vtk) outputs.push_back(std::make_unique<VtkOutput>(*options.vtk, scene));
  if (options.output) {
    outputs.push_back(std::make_unique<RunOutput>(
        *options.output, scene,
        RunOrigin{options.trace.filename().string(), options.from_tips ? "tips" : "forces"}));
  }
  return outputs;
}

void put_frame(const MadeAgain& made, const StepRecord& record, std::vector<Points>& surfaces,
               Outputs& outputs) {
  bool looked_at = false;
  for (const auto& output : outputs) looked_at = looked_at || output->needs_surfaces();
  for (std::size_t i = 0; i < surfaces.size() && looked_at; ++i) made.displacement(i, surfaces[i]);
  for (const auto& output : outputs) output->put({record, surfaces});
}

}  // namespace

int replay(const ReplayOptions& options) {
  const TracedScene scene = read_traced_scene(options.trace, options.models, options.engine);
  for (const std::string& warning : scene.warnings) {
    std::cerr << "irdm-replay: warning: " << warning << '\n';
  }
  const Recording recording = read_recording(scene, options.trace.string());
  const FrameSteps frames(recording.steps(), scene.dt(), options.rate);
  const auto made = make_again(scene, options);
  Outputs outputs = make_outputs(options, scene);
  std::vector<Points> surfaces(scene.config.objects.size());
  Deviation deviation;
  const auto recorded = std::make_unique<StepRecord>();
  const auto again = std::make_unique<StepRecord>();
  for (std::size_t k = 0; k < recording.steps(); ++k) {
    recording.step(k, *recorded);
    scene.choose_engine(recorded->settings);
    made->step(*recorded, *again);
    deviation.add(*recorded, *again);
    if (frames.has(k)) put_frame(*made, *again, surfaces, outputs);
  }
  for (const auto& output : outputs) output->finish();
  std::cout << options.trace.string() << ": " << recording.steps() << " steps of " << scene.dt()
            << " s from " << (options.from_tips ? "tips" : "forces") << ", engine "
            << scene.engine_words() << "; " << frames.count() << " frames\n"
            << deviation.text() << std::flush;
  return 0;
}

}  // namespace irdm::replay
