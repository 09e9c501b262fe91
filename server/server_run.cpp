#include "server/server_run.hpp"

#include <omp.h>

#include <algorithm>
#include <iostream>

#include "common/error.hpp"
#include "server/run_report.hpp"
#include "simulation/step/settings.hpp"

namespace irdm {
namespace {

// In lockstep nobody waits for the machine's clock.
RealTimeScheduling scheduling_of(const PreparedRun& run) {
  return run.lockstep ? RealTimeScheduling::kIgnore : run.scene.server.realtime;
}

NetworkSettings network_settings(const PreparedRun& run, RealTimeScheduling scheduling,
                                 bool any_datagram_port, wire::FrameTap* tap) {
  const SceneConfig& scene = run.scene;
  NetworkSettings settings;
  settings.address = scene.server.address;
  settings.port = static_cast<std::uint16_t>(scene.server.port);
  settings.dt = run.simulation.dt();
  settings.lockstep = run.lockstep;
  settings.styluses = static_cast<int>(scene.styluses.size());
  // One bridge may have all of them, or each its own, with another one that comes in its place.
  settings.max_frame_rate = std::max(settings.max_frame_rate, 10'000 * settings.styluses);
  settings.max_connections = std::max(settings.max_connections, 2 * settings.styluses);
  settings.contact_models = std::none_of(
      scene.styluses.begin(), scene.styluses.end(),
      [](const SimulationStylus& stylus) { return stylus.tool.has_value() || stylus.has_ball(); });
  settings.scheduling = scheduling;
  settings.udp = scene.server.udp;
  settings.any_datagram_port = any_datagram_port;
  settings.tap = tap;
  if (scene.server.key_file) settings.key = wire::read_key_file(*scene.server.key_file);
  return settings;
}

int deformation_threads(const ServerConfig& config) {
  if (config.deformation_threads > 0) return config.deformation_threads;
  return std::max(1, omp_get_num_procs() - 1);
}

std::optional<std::filesystem::path> recordings_folder(const ViewerConfig& config) {
  return config.enabled ? config.recordings : std::nullopt;
}

}  // namespace

ServerRun::ServerRun(PreparedRun& run, SceneLoader& loader, const Options& options)
    : run_(run),
      loader_(loader),
      options_(options),
      scheduling_(scheduling_of(run)),
      black_box_(run.scene.server.black_box, run.lockstep),
      network_(network_settings(run, scheduling_, options.any_datagram_port, black_box_.frames())),
      control_(run.simulation.settings()),
      deformation_(run.config, run.scene.server.deformation_rate,
                   deformation_threads(run.scene.server)),
      recorder_sink_(options.record ? RecorderThread::kQueueCapacity : 1, step_shape(run.config)),
      recorder_(make_recorder()),
      recordings_(recordings_folder(run.scene.viewer), run.header, step_shape(run.config)),
      clock_(make_clock()),
      force_(run.simulation, network_, control_, *clock_, sinks(), options.steps),
      viewers_(make_viewers()),
      status_({force_, network_, deformation_, recorder_.get()}, run.scene.server.status_period) {}

std::unique_ptr<RecorderThread> ServerRun::make_recorder() {
  if (!options_.record) return nullptr;
  return std::make_unique<RecorderThread>(*options_.record, run_.header, recorder_sink_);
}

std::vector<StepSink*> ServerRun::sinks() {
  std::vector<StepSink*> sinks{&deformation_.sink(), &recordings_.sink()};
  if (recorder_) sinks.push_back(&recorder_sink_);
  return sinks;
}

std::unique_ptr<StepClock> ServerRun::make_clock() {
  if (run_.lockstep) return std::make_unique<LockstepClock>(network_, sinks());
  return std::make_unique<RealTimeClock>(run_.simulation.dt());
}

std::unique_ptr<Viewers> ServerRun::make_viewers() {
  const ViewerConfig& viewer = run_.scene.viewer;
  force_.set_position_bound(run_.scene.world.bound);
  if (run_.viewer_stylus) {
    force_.add_viewer_stylus(
        {run_.simulation.dt(), viewer.stylus.coupling_stiffness, viewer.max_force});
  }
  if (!viewer.enabled) return nullptr;
  return std::make_unique<Viewers>(run_, deformation_threads(run_.scene.server), no_other_scene(),
                                   Viewers::Parts{deformation_, force_, control_, network_,
                                                  recordings_, loader_, recorder_.get()});
}

std::string ServerRun::no_other_scene() const {
  if (run_.lockstep) return "this run is in lockstep";
  return options_.record ? "this run is recorded as a whole (--record)" : "";
}

void ServerRun::start() {
  memory_ = lock_memory(scheduling_);
  run_.columns.start(real_time());
  black_box_.start(force_);
  run_.lockstep ? network_.open() : network_.start();
  run_.notes.say();
  say_where(network_.endpoints());
  if (viewers_) {
    viewers_->start();
    say_where(viewers_->urls());
  }
  if (recorder_) recorder_->start();
  deformation_.start(real_time());
  force_.start(scheduling_);
  if (!run_.lockstep) status_.start();
}

void ServerRun::finish() {
  status_.finish();
  force_.finish();
  network_.stop();
  black_box_.finish();
  deformation_.finish();
  if (viewers_) viewers_->stop();
  end_recording();
  if (recorder_) recorder_->finish();
  run_.columns.finish();
}

// What a viewer records ends with the run.
void ServerRun::end_recording() {
  try {
    recordings_.end();
  } catch (const Error& error) {
    std::cerr << "irdm-server: warning: " << error.what() << '\n';
  }
}

int ServerRun::report() const {
  return print_report({force_, network_, deformation_, recorder_.get(),
                       options_.record ? options_.record->string() : "",
                       dynamic_cast<const RealTimeClock*>(clock_.get()), memory_, run_.columns,
                       viewers_ ? viewers_->unlogged() : 0});
}

}  // namespace irdm
