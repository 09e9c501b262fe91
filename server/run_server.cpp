#include "server/run_server.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include "common/blackbox/frame_log.hpp"
#include "common/checksum.hpp"
#include "common/contact/contact_model.hpp"
#include "common/error.hpp"
#include "common/number_text.hpp"
#include "common/program/program.hpp"
#include "common/realtime/event_fd.hpp"
#include "common/realtime/scheduling.hpp"
#include "scene/scene.hpp"
#include "server/blackbox/step_log.hpp"
#include "server/stylus_notes.hpp"
#include "server/threads/deformation_thread.hpp"
#include "server/threads/force_thread.hpp"
#include "server/threads/recorder_thread.hpp"
#include "server/threads/status_thread.hpp"
#include "server/threads/step_clock.hpp"
#include "server/viewer_session/live_run.hpp"
#include "server/viewer_session/playback.hpp"
#include "simulation/step/settings.hpp"
#include "trace/recording.hpp"
#include "trace/trace_layout.hpp"
#include "viewer/scene_message.hpp"

namespace irdm {
namespace {

/// The threads of a run that has ended.
struct FinishedRun {
  const ForceThread& force;
  const NetworkServer& network;
  const DeformationThread& deformation;
  const RecorderThread* recorder;  ///< null: not recorded
  const RealTimeClock* clock;      ///< null: lockstep
  std::string memory;              ///< whether it is locked, in words
  const SceneColumns& columns;
  std::uint64_t viewers_unlogged;  ///< complaints about viewers beyond what is logged
};

std::string microseconds(const Histogram& histogram) {
  const auto value = [](std::int64_t ns) { return static_cast<double>(ns) / 1000.0; };
  char text[128];
  std::snprintf(text, sizeof text, "p50 %.1f us, p99 %.1f us, max %.1f us",
                value(histogram.percentile(0.5)), value(histogram.percentile(0.99)),
                value(histogram.maximum()));
  return text;
}

// Prints how the run went and returns the exit status: 1 when the recording is not whole.
int print_report(const FinishedRun& run, const ServerOptions& options) {
  const ForceThreadReport& force = run.force.report();
  std::cout << "steps: " << force.steps << '\n';
  if (run.clock != nullptr) {
    std::cout << "real-time scheduling: " << run.force.scheduling() << ", memory " << run.memory
              << '\n'
              << "missed deadlines: " << run.clock->missed() << ", made up for "
              << run.clock->made_up() << '\n'
              << "wake-up delay: " << microseconds(run.clock->wakeup_delay()) << '\n';
  }
  char peak[32];
  std::snprintf(peak, sizeof peak, "%.3f", force.peak_force);
  std::cout << "step time: " << microseconds(force.step_time) << '\n';
  if (force.prediction_time.count() > 0) {
    std::cout << "of which prediction: " << microseconds(force.prediction_time) << '\n';
  }
  std::cout << "peak force: " << peak << " N\n"
            << "reset: " << force.resets << " times\n"
            << "steps without a finite solution: " << force.unsolved << '\n'
            << "surfaces: " << run.deformation.frames() << ", each "
            << microseconds(run.deformation.compute_time()) << '\n'
            << "sessions: " << run.network.stats().accepted << " accepted, "
            << run.network.stats().refused << " refused, " << run.network.stats().protocol_errors
            << " closed for protocol errors\n";
  const auto faults = [](const char* what, std::uint64_t count) {
    if (count > 0) std::cout << what << ": " << count << '\n';
  };
  faults("forces that were not finite, sent as zero", run.network.stats().forces_not_finite);
  faults("connections cut before their Hello, for another", run.network.stats().displaced);
  faults("connections without the server's key", run.network.stats().wrong_keys);
  faults("connections closed for being silent", run.network.stats().timeouts);
  faults("connections closed for too many messages", run.network.stats().too_fast);
  faults("datagrams that were spoilt, foreign or came twice, dropped",
         run.network.stats().datagrams_foreign + run.network.stats().datagrams_forged +
             run.network.stats().datagrams_replayed);
  faults("messages that a newer one had overtaken, dropped", run.network.stats().messages_late);
  faults("lines about bridges that were not logged", run.network.stats().unlogged);
  faults("lines about viewers that were not logged", run.viewers_unlogged);
  faults("errors inside the network thread", run.network.stats().internal_errors);
  faults("forces of bridges that came late, entered at their own step", force.late);
  faults("forces of bridges that were lost", force.lost);
  faults("forces of bridges above their stylus' max_force, lowered to it", force.bounded);
  faults("forces of bridges reduced, since they would put in more energy than hands gave",
         force.limited);
  if (run.columns.any()) {
    std::cout << "nodes whose columns were read: " << run.columns.loaded()
              << ", cache misses: " << force.cache_misses << '\n';
  }
  faults("nodes whose columns cannot be read", run.columns.failed());
  faults("steps that the deformation did not see", run.deformation.lost_steps());
  if (run.recorder == nullptr) return 0;
  if (!run.recorder->error().empty()) {
    std::cerr << "irdm-server: error: recording ended early: " << run.recorder->error() << '\n';
    return 1;
  }
  std::cout << "recorded: " << run.recorder->rows() << " steps in " << options.record->string()
            << std::endl;
  if (const std::uint64_t lost = run.recorder->lost()) {
    std::cerr << "irdm-server: error: " << lost << " steps are missing in the trace: "
              << "the disk was too slow; record to a faster one\n";
    return 1;
  }
  return 0;
}

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
  const SceneConfig scene = read_scene(TomlTable::parse_file(options.scene));
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
  std::cout << "listening on " + viewers.url() + "\n" << std::flush;
  const EventFd never;
  stop.wait(never.descriptor());
  viewers.stop();
  player.finish();
  return 0;
}

namespace {

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
        "object " + in_quotes(scene.objects[i].name) +
            " is fixed and contact.coupling_stiffness is 0, so that nothing yields where it "
            "is clamped",
        "set contact.coupling_stiffness, for instance to 2000 (N/m)");
  }
}

// Such a run can be looked at, and played in lockstep.
void warn_of_long_steps(double dt, bool lockstep, const std::string& name) {
  if (lockstep || dt <= kLongestForceStep) return;
  std::cerr << "irdm-server: warning: " << name << ": the model's dt of " << dt
            << " s is too long for a hand: above " << kLongestForceStep
            << " s bridges predict no contact and let held forces fade between steps; compute the "
               "model with a shorter response.dt\n";
}

// Gravity that nobody sees would be taken for a mistake.
void warn_of_missing_sag(const SceneConfig& scene, const SimulationConfig& config,
                         const std::string& name) {
  for (std::size_t i = 0; i < config.objects.size() && !config.gravity.isZero(0.0); ++i) {
    if (takes_gravity(config.objects[i])) continue;
    const bool compressed =
        std::holds_alternative<CompressedResponse>(config.objects[i].model->response);
    std::cerr << "irdm-server: warning: " << name << ": fixed object '" << scene.objects[i].name
              << "' does not sag under gravity: its model "
              << (compressed ? "is compressed, which leaves gravity out; use engine = \"modal\" or "
                               "\"dense\""
                             : "does not say how; precompute it again with method = \"modal\"")
              << '\n';
  }
}

/// How styluses touch: found before the run, said when it starts.
class TouchNotes {
 public:
  TouchNotes(const SceneConfig& scene, const SimulationConfig& config, bool viewer_stylus,
             const std::string& name)
      : note_(default_fingertip_note(scene, config, viewer_stylus)) {
    for (const std::string& warning :
         {point_warning(scene, config, viewer_stylus), coupling_warning(scene, config)}) {
      if (!warning.empty()) warnings_ += "irdm-server: warning: " + name + ": " + warning + "\n";
    }
  }
  void say() const {
    if (!note_.empty()) std::cout << note_ + "\n" << std::flush;
    std::cerr << warnings_;
  }

 private:
  std::string note_, warnings_;
};

// In lockstep nobody waits for the machine's clock.
RealTimeScheduling scheduling(const SceneConfig& scene, const ServerOptions& options) {
  return options.lockstep ? RealTimeScheduling::kIgnore : scene.server.realtime;
}

/// What a server leaves when something went wrong. Not in lockstep: there is no hand to be felt
/// for.
class ServerBlackBox {
 public:
  ServerBlackBox(const BlackBoxSettings& settings, bool lockstep) {
    if (!settings.folder.empty() && !lockstep) box_.emplace(settings, "irdm-server", parts());
  }
  FrameLog* frames() noexcept { return box_ ? &frames_ : nullptr; }
  void start(ForceThread& force) {
    if (!box_) return;
    force.write_down_in(steps_);
    box_->start();
  }
  /// When force and network thread have ended.
  void finish() {
    if (box_) box_->finish();
  }

 private:
  std::vector<BlackBoxPart*> parts() { return {&steps_, &frames_}; }

  StepLog steps_;
  FrameLog frames_;
  std::optional<BlackBox> box_;
};

NetworkSettings network_settings(const SceneConfig& scene, const ServerOptions& options, double dt,
                                 wire::FrameTap* tap) {
  NetworkSettings settings;
  settings.address = scene.server.address;
  settings.port = static_cast<std::uint16_t>(options.port.value_or(scene.server.port));
  settings.dt = dt;
  settings.lockstep = options.lockstep;
  settings.styluses = static_cast<int>(scene.styluses.size());
  // One bridge may have all of them, or each its own, with another one that comes in its place.
  settings.max_frame_rate = std::max(settings.max_frame_rate, 10'000 * settings.styluses);
  settings.max_connections = std::max(settings.max_connections, 2 * settings.styluses);
  settings.contact_models =
      std::none_of(scene.styluses.begin(), scene.styluses.end(),
                   [](const SimulationStylus& stylus) { return stylus.tool.has_value(); });
  settings.scheduling = scheduling(scene, options);
  settings.udp = scene.server.udp;
  settings.tap = tap;
  if (scene.server.key_file) settings.key = wire::read_key_file(*scene.server.key_file);
  return settings;
}

TraceHeader trace_header(const SceneConfig& scene, const ServerOptions& options,
                         const SimulationConfig& config) {
  TraceHeader header;
  for (const ObjectConfig& object : scene.objects) {
    header.objects.push_back(
        {object.name, object.model.filename().string(), sha256_of_file(object.model)});
  }
  header.scene = read_text(options.scene);
  header.dt = config.objects.front().model->dt;
  header.floor = scene.floor.has_value();
  header.bodies = touches_bodies(config);
  header.stylus_count = static_cast<int>(config.styluses.size());
  header.tools = tool_styluses(config);
  header.sleep = config.sleep_time > 0;
  return header;
}

std::unique_ptr<StepClock> make_clock(bool lockstep, NetworkServer& network,
                                      const std::vector<StepSink*>& sinks, double dt) {
  if (lockstep) return std::make_unique<LockstepClock>(network, sinks);
  return std::make_unique<RealTimeClock>(dt);
}

std::vector<std::string> names_of(const SceneConfig& scene) {
  std::vector<std::string> names;
  for (const ObjectConfig& object : scene.objects) names.push_back(object.name);
  return names;
}

int deformation_threads(const ServerConfig& config) {
  if (config.deformation_threads > 0) return config.deformation_threads;
  return std::max(1, omp_get_num_procs() - 1);
}

// In one piece, so that no other thread's line comes between.
void say_where(const std::string& where) {
  std::cout << "listening on " + where + "\n" << std::flush;
}

/// The viewers of a live run, and what they need besides its threads.
class Viewers {
 public:
  Viewers(const SceneConfig& scene, const SimulationConfig& config, bool viewer_stylus,
          bool lockstep, Recordings& recordings, DeformationThread& deformation, ForceThread& force,
          RunControl& control, NetworkServer& network)
      : player_(config, names_of(scene), scene.server.deformation_rate,
                deformation_threads(scene.server)),
        run_(live_scene(scene, config, viewer_stylus, lockstep), config,
             {deformation, force, control, network, recordings, player_}),
        server_(viewer_settings(scene.viewer), run_) {}

  void start() {
    player_.start();
    server_.start();
    say_where(server_.url());
  }
  void stop() {
    server_.stop();
    player_.finish();
  }
  std::uint64_t unlogged() const noexcept { return server_.unlogged(); }

 private:
  static viewer::Scene live_scene(const SceneConfig& scene, const SimulationConfig& config,
                                  bool viewer_stylus, bool lockstep) {
    viewer::Scene seen = viewer_scene(names_of(scene), config);
    seen.lockstep = lockstep;
    seen.viewer_stylus = viewer_stylus;
    seen.max_force = static_cast<float>(scene.viewer.max_force);
    return seen;
  }

  Player player_;
  LiveRun run_;
  viewer::ViewerServer server_;
};

// What a viewer records ends with the run.
void end_recording(Recordings& recordings) {
  try {
    recordings.end();
  } catch (const Error& error) {
    std::cerr << "irdm-server: warning: " << error.what() << '\n';
  }
}

}  // namespace

int run_server(const ServerOptions& options) {
  StopSignal stop;
  SceneConfig scene = read_scene(TomlTable::parse_file(options.scene));
  if (options.no_viewer) scene.viewer.enabled = false;
  if (options.recordings) scene.viewer.recordings = options.recordings;
  const bool viewer_stylus = has_viewer_stylus(scene, options.lockstep);
  SceneColumns columns(options.lockstep);
  const SimulationConfig config = simulation_config(scene, viewer_stylus, &columns);
  check_coupling(scene, config, options.scene.string());
  Simulation simulation(config);
  const double dt = simulation.dt();
  warn_of_missing_sag(scene, config, options.scene.string());
  const TouchNotes touch(scene, config, viewer_stylus, options.scene.string());
  warn_of_long_steps(dt, options.lockstep, options.scene.string());
  ServerBlackBox black_box(scene.server.black_box, options.lockstep);
  NetworkServer network(network_settings(scene, options, dt, black_box.frames()));
  RunControl control(simulation.settings());
  DeformationThread deformation(config, scene.server.deformation_rate,
                                deformation_threads(scene.server));
  const bool records = options.record.has_value();
  const bool lets_record = scene.viewer.enabled && scene.viewer.recordings.has_value();
  const TraceHeader header =
      records || lets_record ? trace_header(scene, options, config) : TraceHeader{};
  StepSink recorder_sink(records ? RecorderThread::kQueueCapacity : 1, step_shape(config));
  const auto recorder =
      records ? std::make_unique<RecorderThread>(*options.record, header, recorder_sink) : nullptr;
  Recordings recordings(lets_record ? scene.viewer.recordings : std::nullopt, header,
                        step_shape(config));

  std::vector<StepSink*> sinks{&deformation.sink(), &recordings.sink()};
  if (recorder) sinks.push_back(&recorder_sink);
  const std::unique_ptr<StepClock> clock = make_clock(options.lockstep, network, sinks, dt);
  const auto steps = static_cast<std::uint64_t>(
      std::llround(std::ceil(options.duration.value_or(0.0) / dt - 1e-9)));
  ForceThread force(simulation, network, control, *clock, sinks, steps);
  if (viewer_stylus) {
    force.add_viewer_stylus({dt, scene.viewer.stylus.coupling_stiffness, scene.viewer.max_force});
  }
  const auto viewers = scene.viewer.enabled ? std::make_unique<Viewers>(
                                                  scene, config, viewer_stylus, options.lockstep,
                                                  recordings, deformation, force, control, network)
                                            : nullptr;

  StatusThread status({force, network, deformation, recorder.get()}, scene.server.status_period);

  const std::string memory = lock_memory(scheduling(scene, options));
  columns.start(scheduling(scene, options) != RealTimeScheduling::kIgnore);
  black_box.start(force);
  options.lockstep ? network.open() : network.start();
  touch.say();
  say_where(network.endpoint());
  if (viewers) viewers->start();
  if (recorder) recorder->start();
  deformation.start(scheduling(scene, options) != RealTimeScheduling::kIgnore);
  force.start(scheduling(scene, options));
  if (!options.lockstep) status.start();
  stop.wait(force.finished().descriptor());

  status.finish();
  force.finish();
  network.stop();
  black_box.finish();
  deformation.finish();
  if (viewers) viewers->stop();
  end_recording(recordings);
  if (recorder) recorder->finish();
  columns.finish();
  return print_report(
      {force, network, deformation, recorder.get(), dynamic_cast<RealTimeClock*>(clock.get()),
       memory, columns, viewers ? viewers->unlogged() : 0},
      options);
}

}  // namespace irdm
