#include "server/run_server.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "common/checksum.hpp"
#include "common/error.hpp"
#include "common/model/model_file.hpp"
#include "common/program/stop_signal.hpp"
#include "server/config/scene.hpp"
#include "server/report.hpp"
#include "server/step/inertial_loading.hpp"
#include "server/threads/deformation_thread.hpp"
#include "server/threads/force_thread.hpp"
#include "server/threads/recorder_thread.hpp"
#include "server/threads/step_clock.hpp"
#include "server/viewer_feed.hpp"

namespace irdm {
namespace {

std::shared_ptr<const Model> load_model(const ObjectConfig& object) {
  const bool dense = object.engine == EngineKind::kDense;
  Model model = read_model(object.model, dense ? ResponseKind::kDense : ResponseKind::kModal);
  check_inertial_loading(model, object.inertial_loading, object.model.string());
  return std::make_shared<const Model>(std::move(model));
}

SimulationConfig simulation_config(const SceneConfig& scene) {
  SimulationConfig config;
  config.gravity = scene.world.gravity;
  for (const ObjectConfig& object : scene.objects) {
    config.objects.push_back({load_model(object), object.position, object.orientation,
                              object.velocity, object.angular_velocity, object.friction,
                              object.damping, object.tether, object.inertial_loading});
  }
  config.styluses = scene.styluses;
  config.floor = scene.floor;
  config.release_time = scene.contact.release_time;
  return config;
}

// Where a fixed object is clamped its surface does not yield at all: without a spring between tip
// and surface no force takes the one to the other.
void check_coupling(const SceneConfig& scene, const SimulationConfig& config,
                    const std::string& name) {
  const bool rigid =
      std::any_of(config.styluses.begin(), config.styluses.end(),
                  [](const SimulationStylus& stylus) { return stylus.coupling_stiffness <= 0.0; });
  for (std::size_t i = 0; rigid && i < config.objects.size(); ++i) {
    if (config.objects[i].model->body.support != Support::kFixed) continue;
    throw Error(
        name,
        "object '" + scene.objects[i].name +
            "' is fixed and contact.coupling_stiffness is 0, so that nothing yields where it "
            "is clamped",
        "set contact.coupling_stiffness, for instance to 2000 (N/m)");
  }
}

// In lockstep nobody waits for the machine's clock.
RealTimeScheduling scheduling(const SceneConfig& scene, const ServerOptions& options) {
  return options.lockstep ? RealTimeScheduling::kIgnore : scene.server.realtime;
}

NetworkSettings network_settings(const SceneConfig& scene, const ServerOptions& options,
                                 double dt) {
  NetworkSettings settings;
  settings.address = scene.server.address;
  settings.port = static_cast<std::uint16_t>(options.port.value_or(scene.server.port));
  settings.dt = dt;
  settings.lockstep = options.lockstep;
  settings.styluses = static_cast<int>(scene.styluses.size());
  settings.scheduling = scheduling(scene, options);
  return settings;
}

std::unique_ptr<RecorderThread> make_recorder(const SceneConfig& scene,
                                              const ServerOptions& options, double dt) {
  if (!options.record) return nullptr;
  TraceHeader header;
  for (const ObjectConfig& object : scene.objects) {
    header.objects.push_back(
        {object.name, object.model.filename().string(), sha256_of_file(object.model)});
  }
  header.scene = read_text(options.scene);
  header.dt = dt;
  header.floor = scene.floor.has_value();
  header.stylus_count = static_cast<int>(scene.styluses.size());
  return std::make_unique<RecorderThread>(*options.record, header);
}

std::unique_ptr<StepClock> make_clock(bool lockstep, NetworkServer& network,
                                      const std::vector<StepSink*>& sinks, double dt) {
  if (lockstep) return std::make_unique<LockstepClock>(network, sinks);
  return std::make_unique<RealTimeClock>(dt);
}

std::unique_ptr<viewer::ViewerServer> make_viewer(const SceneConfig& scene,
                                                  const ServerOptions& options,
                                                  viewer::ViewerFeed feed) {
  if (!scene.viewer.enabled || options.no_viewer) return nullptr;
  return std::make_unique<viewer::ViewerServer>(viewer_settings(scene.viewer), std::move(feed));
}

int deformation_threads(const ServerConfig& config) {
  if (config.deformation_threads > 0) return config.deformation_threads;
  return std::max(1, omp_get_num_procs() - 1);
}

}  // namespace

int run_server(const ServerOptions& options) {
  StopSignal stop;
  const SceneConfig scene = read_scene(TomlTable::parse_file(options.scene));
  const SimulationConfig config = simulation_config(scene);
  check_coupling(scene, config, options.scene.string());
  Simulation simulation(config);
  const double dt = simulation.dt();
  NetworkServer network(network_settings(scene, options, dt));
  DeformationThread deformation(config, scene.server.deformation_rate,
                                deformation_threads(scene.server));
  const std::unique_ptr<RecorderThread> recorder = make_recorder(scene, options, dt);

  std::vector<StepSink*> sinks{&deformation.sink()};
  if (recorder) sinks.push_back(&recorder->sink());
  const std::unique_ptr<StepClock> clock = make_clock(options.lockstep, network, sinks, dt);
  const auto steps = static_cast<std::uint64_t>(
      std::llround(std::ceil(options.duration.value_or(0.0) / dt - 1e-9)));
  ForceThread force(simulation, network, *clock, sinks, steps);
  const std::unique_ptr<viewer::ViewerServer> viewers = make_viewer(
      scene, options, viewer_feed(scene, config, options.lockstep, deformation, force, network));

  network.start();
  // In one piece, so that no other thread's line comes between.
  std::cout << "listening on " + network.endpoint() + "\n" << std::flush;
  if (viewers) {
    viewers->start();
    std::cout << "listening on " + viewers->url() + "\n" << std::flush;
  }
  if (recorder) recorder->start();
  deformation.start();
  force.start(scheduling(scene, options));
  stop.wait(force.finished().descriptor());

  force.finish();
  network.stop();
  deformation.finish();
  if (viewers) viewers->stop();
  if (recorder) recorder->finish();
  return print_report(
      {force, network, deformation, recorder.get(), dynamic_cast<RealTimeClock*>(clock.get())},
      options);
}

}  // namespace irdm
