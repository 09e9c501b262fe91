#include <omp.h>

#include <algorithm>
#include <iostream>

#include "common/checksum.hpp"
#include "common/error.hpp"
#include "common/program/program.hpp"
#include "common/realtime/event_fd.hpp"
#include "scene/scene.hpp"
#include "server/run_server.hpp"
#include "server/viewer_session/playback.hpp"
#include "trace/recording.hpp"
#include "trace/trace_layout.hpp"
#include "viewer/scene_message.hpp"

namespace irdm {
namespace {

void check_model(const SceneConfig& scene, const TraceHeader& header, const std::string& trace) {
  const std::filesystem::path& model = scene.objects.front().model;
  if (sha256_of_file(model) == header.objects.front().model_checksum) return;
  throw Error(trace, "was recorded with another " + model.filename().string(),
              "give the scene and the model that it was recorded with");
}

}  // namespace

int run_playback(const ServerOptions& options) {
  StopSignal stop;
  const SceneConfig scene = read_scene(TomlTable::parse_file(options.scene));
  const std::string trace = options.play->string();
  const TraceHeader header = read_trace_header(*options.play);
  check_model(scene, header, trace);
  const bool viewer_stylus = recorded_viewer_stylus(scene, header.stylus_count, trace);
  SceneColumns columns(false);
  const SimulationConfig config = simulation_config(scene, viewer_stylus, &columns);
  std::vector<std::string> names;
  for (const ObjectConfig& object : scene.objects) names.push_back(object.name);
  Recording(*options.play, config, names);  // so that what is wrong with it is said here
  Player player(config, names, scene.server.deformation_rate, std::max(1, omp_get_num_procs()));
  RecordedRun run(viewer_scene(names, config), config, player, *options.play);
  viewer::ViewerServer viewers(viewer_settings(scene.viewer), run);
  columns.start(false);
  player.start();
  viewers.start();
  std::cout << "listening on " + viewers.url() + "\n" << std::flush;
  const EventFd never;
  stop.wait(never.descriptor());
  viewers.stop();
  player.finish();
  return 0;
}

}  // namespace irdm
