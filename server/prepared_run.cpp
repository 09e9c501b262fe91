#include "server/prepared_run.hpp"

#include "common/checksum.hpp"
#include "scene/saved_scene.hpp"
#include "viewer/scene_message.hpp"

namespace irdm {
namespace {

SimulationConfig checked_config(const SceneConfig& scene, bool viewer_stylus, SceneColumns& columns,
                                const std::string& name) {
  SimulationConfig config = simulation_config(scene, viewer_stylus, &columns);
  check_coupling(scene, config, name);
  return config;
}

TraceHeader trace_header(const SceneConfig& scene, const std::string& text,
                         const SimulationConfig& config) {
  TraceHeader header;
  for (const ObjectConfig& object : scene.objects) {
    header.objects.push_back(
        {object.name, object.model.filename().string(), sha256_of_file(object.model)});
  }
  header.scene = text;
  header.dt = config.objects.front().model->dt;
  header.floor = scene.floor.has_value();
  header.bodies = touches_bodies(config);
  header.stylus_count = static_cast<int>(config.styluses.size());
  header.tools = tool_styluses(config);
  header.sleep = config.sleep_time > 0;
  return header;
}

viewer::Scene live_scene(const SceneConfig& scene, const SimulationConfig& config,
                         bool viewer_stylus, bool lockstep) {
  viewer::Scene seen = viewer_scene(names_of(scene), config);
  seen.lockstep = lockstep;
  seen.viewer_stylus = viewer_stylus;
  seen.max_force = static_cast<float>(scene.viewer.max_force);
  return seen;
}

}  // namespace

PreparedRun::PreparedRun(SceneSource from, SceneConfig read, bool in_lockstep, bool records)
    : source(std::move(from)),
      scene(std::move(read)),
      lockstep(in_lockstep),
      viewer_stylus(has_viewer_stylus(scene, lockstep)),
      columns(lockstep),
      config(checked_config(scene, viewer_stylus, columns, source.name)),
      simulation(config),
      notes(scene_notes(scene, config, viewer_stylus, lockstep, source.name)) {
  if (records) header = trace_header(scene, without_secrets(source), config);
  if (scene.viewer.enabled) seen = live_scene(scene, config, viewer_stylus, lockstep);
}

std::vector<std::string> names_of(const SceneConfig& scene) {
  std::vector<std::string> names;
  for (const ObjectConfig& object : scene.objects) names.push_back(object.name);
  return names;
}

}  // namespace irdm
