#include "server/run_server.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <thread>

#include "common/program/stop_signal.hpp"
#include "common/realtime/event_fd.hpp"
#include "server/prepared_run.hpp"
#include "server/scene_loader.hpp"
#include "server/server_run.hpp"
#include "viewer/scene_message.hpp"

namespace irdm {
namespace {

SceneConfig first_scene(const SceneSource& source, const ServerOptions& options) {
  SceneConfig scene = read_scene(source);
  if (options.no_viewer) scene.viewer.enabled = false;
  if (scene.viewer.enabled) load_tokens(scene.viewer);  // once, for every scene that follows
  if (options.recordings) scene.viewer.recordings = options.recordings;
  if (options.scenes) scene.viewer.scenes = options.scenes;
  if (options.port) scene.server.port = *options.port;
  return scene;
}

// What bridges, browsers and machine see stays as the first scene had it.
void keep_place(const SceneConfig& first, SceneConfig& scene) {
  ServerConfig server = first.server;
  server.styluses = scene.server.styluses;
  server.deformation_rate = scene.server.deformation_rate;
  scene.server = server;
  ViewerConfig viewer = first.viewer;
  viewer.mouse = scene.viewer.mouse;
  viewer.stylus = scene.viewer.stylus;
  viewer.default_radius = scene.viewer.default_radius;
  viewer.max_force = scene.viewer.max_force;
  scene.viewer = viewer;
}

[[noreturn]] void end_at_once(int status) {
  std::cout << std::flush;
  std::_Exit(status);
}

// 0: no end.
std::uint64_t steps_in(double duration, double dt) {
  return static_cast<std::uint64_t>(std::llround(std::ceil(duration / dt - 1e-9)));
}

/// Ends the program at once where a signal asks it to stop while a scene or a model is read, which
/// cannot be interrupted: nothing is running or written yet.
class StopWhileLoading {
 public:
  explicit StopWhileLoading(StopSignal& stop)
      : thread_([this, &stop] {
          if (stop.wait(done_.descriptor())) end_at_once(0);
        }) {}
  StopWhileLoading(const StopWhileLoading&) = delete;
  StopWhileLoading& operator=(const StopWhileLoading&) = delete;
  ~StopWhileLoading() {
    done_.signal();
    thread_.join();
  }

 private:
  EventFd done_;
  std::thread thread_;
};

/// A server's runs, one after the other at the same place.
class Runs {
 public:
  explicit Runs(const ServerOptions& options)
      : options_(options),
        source_(read_scene_source(options.scene)),
        first_(first_scene(source_, options)),
        any_port_(first_.server.port == 0),
        left_(options.duration),
        loader_(first_.viewer.enabled ? first_.viewer.scenes : std::nullopt,
                [this](const SceneSource& source) { return prepare(source); }) {}

  int run_all() {
    {
      const StopWhileLoading stopping(stop_);
      prepared_ = make(source_, first_);
    }
    prepared_->name = loader_.name_of(source_);
    int status = 0;
    for (; prepared_; prepared_ = std::move(next_)) status = std::max(status, run_one());
    if (loader_.loading()) end_at_once(status);
    return status;
  }

 private:
  std::unique_ptr<PreparedRun> make(const SceneSource& source, const SceneConfig& scene) const {
    const bool records =
        options_.record || (scene.viewer.enabled && scene.viewer.recordings.has_value());
    return std::make_unique<PreparedRun>(source, scene, options_.lockstep, records);
  }
  // The loader's thread.
  std::unique_ptr<PreparedRun> prepare(const SceneSource& source) const {
    SceneConfig scene = read_scene(source);
    keep_place(first_, scene);
    return make(source, scene);
  }

  int run_one() {
    const double dt = prepared_->simulation.dt();
    ServerRun run(*prepared_, loader_,
                  {options_.record, steps_in(left_.value_or(0.0), dt), any_port_});
    // Before the loader reads them, and never again.
    if (first_.server.port == 0) first_.server.port = run.port();
    if (first_.viewer.port == 0) first_.viewer.port = run.viewer_port();
    run.start();
    loader_.start();
    const bool stopped = stop_.wait(run.ended_descriptor(), loader_.ready().descriptor());
    run.finish();
    const int status = run.report();
    if (left_) *left_ -= static_cast<double>(run.steps()) * dt;
    next_ = loader_.take();
    if (stopped || (left_ && *left_ <= 0.5 * dt)) next_ = nullptr;
    return status;
  }

  const ServerOptions& options_;
  StopSignal stop_;  ///< before any thread
  SceneSource source_;
  SceneConfig first_;  ///< with the ports that the system chose
  bool any_port_;
  std::optional<double> left_;  ///< of the duration [s]; none: no end
  std::unique_ptr<PreparedRun> prepared_;
  std::unique_ptr<PreparedRun> next_;
  SceneLoader loader_;
};

}  // namespace

int run_server(const ServerOptions& options) {
  return Runs(options).run_all();
}

}  // namespace irdm
