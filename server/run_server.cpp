#include "server/run_server.hpp"

#include <cmath>

#include "common/program/program.hpp"
#include "server/prepared_run.hpp"
#include "server/server_run.hpp"

namespace irdm {
namespace {

SceneConfig first_scene(const SceneSource& source, const ServerOptions& options) {
  SceneConfig scene = read_scene(source);
  if (options.no_viewer) scene.viewer.enabled = false;
  if (options.recordings) scene.viewer.recordings = options.recordings;
  if (options.port) scene.server.port = *options.port;
  return scene;
}

bool records(const SceneConfig& scene, const ServerOptions& options) {
  return options.record || (scene.viewer.enabled && scene.viewer.recordings);
}

// 0: no end.
std::uint64_t steps_in(double duration, double dt) {
  return static_cast<std::uint64_t>(std::llround(std::ceil(duration / dt - 1e-9)));
}

PreparedRun prepare(const ServerOptions& options) {
  SceneSource source = read_scene_source(options.scene);
  SceneConfig scene = first_scene(source, options);
  const bool recorded = records(scene, options);
  return PreparedRun(std::move(source), std::move(scene), options.lockstep, recorded);
}

}  // namespace

int run_server(const ServerOptions& options) {
  StopSignal stop;
  PreparedRun prepared = prepare(options);
  const double dt = prepared.simulation.dt();
  ServerRun run(prepared, {options.record, steps_in(options.duration.value_or(0.0), dt)});
  run.start();
  stop.wait(run.ended_descriptor());
  run.finish();
  return run.report();
}

}  // namespace irdm
