#include <omp.h>

#include <algorithm>

#include "common/checksum.hpp"
#include "common/error.hpp"
#include "common/number_text.hpp"
#include "common/program/stop_signal.hpp"
#include "common/realtime/event_fd.hpp"
#include "scene/scene.hpp"
#include "server/run_report.hpp"
#include "server/run_server.hpp"
#include "server/viewer_session/playback.hpp"
#include "trace/recording.hpp"
#include "trace/trace_layout.hpp"
#include "viewer/scene_message.hpp"

namespace irdm {
namespace {

// Objects and styluses of a scene, for messages: "2 objects (left, right) and 1 stylus".
std::string parts_text(const SceneConfig& scene) {
  std::string names;
  for (const ObjectConfig& object : scene.objects) {
    names += (names.empty() ? "" : ", ") + shortened(object.name);
  }
  const std::size_t count = scene.objects.size();
  return std::to_string(count) + (count == 1 ? " object (" : " objects (") + names + ") and " +
         styluses_text(scene.styluses.size());
}

// Where a trace's sets are depends on its scene's objects and styluses.
void check_parts(const SceneConfig& scene, const std::string& file, const TraceHeader& header,
                 const std::string& trace) {
  const std::string given = parts_text(scene);
  const std::string recorded =
      parts_text(read_scene(TomlTable::parse_text(header.scene, trace + ", scene")));
  if (given == recorded) return;
  throw Error(
      trace, "was recorded with another scene: " + recorded + "; " + file + " has " + given,
      "give the scene that it was recorded with: its text is the trace's attribute 'scene'");
}

void check_model(const SceneConfig& scene, const TraceHeader& header, const std::string& trace) {
  const std::filesystem::path& model = scene.objects.front().model;
  if (sha256_of_file(model) == header.objects.front().model_checksum) return;
  throw Error(trace, "was recorded with another " + model.filename().string(),
              "give the scene and the model that it was recorded with");
}

}  // namespace

int run_playback(const ServerOptions& options) {
  StopSignal stop;
  SceneConfig scene = read_scene(TomlTable::parse_file(options.scene));
  load_tokens(scene.viewer);
  const std::string trace = options.play->string();
  const TraceHeader header = read_trace_header(*options.play);
  check_parts(scene, options.scene.string(), header, trace);
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
  say_where(viewers.urls());
  const EventFd never;
  stop.wait(never.descriptor());
  viewers.stop();
  player.finish();
  return 0;
}

}  // namespace irdm
